/* Termination detection with aggregation, forwarding and held messages, and the fence after it: a model of
 * protocol/termination.cpp and of the rules in protocol/rank_protocol.hpp (docs/protocol.md has the argument in words).
 * tests/models/check_model.cmake runs spin on it.
 *
 * What is left out: which subdomain a message is for. Whether a rank handles, forwards or holds back a message, and
 * when it releases one, is left to chance, which allows more than the directory does. Work and control messages may
 * overtake each other without limit. Questions reach all ranks in no time, and answers are added up in no time: a delay
 * changes nothing, because a rank that does not look at a question yet is the same, and so is one that answers later.
 *
 * SHAPE is the tree of the three ranks: 0 a star (0 above 1 and 2), 1 a chain (0 above 1 above 2). MUTATION selects a
 * wrong rule; each must violate an assertion (1, 2, 4 to 10) or the formula `found` (3).
 */
#ifndef N
#define N 3
#endif
#ifndef WORK
#define WORK 3      /* messages that may be sent in all */
#endif
#ifndef FORWARDS
#define FORWARDS 2  /* forwardings in all */
#endif
#ifndef CONTROL
#define CONTROL 1   /* control messages in all */
#endif
#ifndef SHAPE
#define SHAPE 0
#endif
#ifndef MUTATION
#define MUTATION 0
#endif

/* The rules, and how each may be broken. */
#if MUTATION == 1   /* counted when leaving the aggregator, which is not looked at */
#define ENTERS 0
#define LEAVES 1
#define AGGREGATOR_EMPTY(i) true
#else
#define ENTERS 1
#define LEAVES 0
#define AGGREGATOR_EMPTY(i) (aggregated[i] == 0)
#endif
#if MUTATION == 2   /* the token is passed by a rank at work */
#define IDLE(i) true
#else
#define IDLE(i) (!busy[i])
#endif
#if MUTATION == 3   /* forwarding counts as sending */
#define FORWARDED 1
#elif MUTATION == 7 /* forwarding counts as handling */
#define FORWARDED -1
#else
#define FORWARDED 0
#endif
#if MUTATION == 4   /* handling does not blacken */
#define BLACKENS false
#else
#define BLACKENS true
#endif
#if MUTATION == 5   /* what is held back counts as handled, and is not looked at */
#define HELD 1
#define NOTHING_HELD(i) true
#else
#define HELD 0
#define NOTHING_HELD(i) (held[i] == 0)
#endif
#if MUTATION == 6   /* rank 0 does not ask for its own color */
#define RANK_0_WHITE true
#else
#define RANK_0_WHITE (!black[0])
#endif

#if MUTATION == 8   /* forwarding whitens */
#define COLOUR_AFTER_FORWARDING(i) false
#else
#define COLOUR_AFTER_FORWARDING(i) black[i]
#endif

/* The ranks below a rank have answered. */
#if SHAPE == 0
#define BELOW_ANSWERED(i) (i != 0 || (answered[1] && answered[2]))
#else
#define BELOW_ANSWERED(i) (i == 2 || answered[i + 1])
#endif
#if MUTATION == 9   /* rank 0 does not wait for the last answer */
#define DUE(i) (BELOW_ANSWERED(i) || (i == 0 && answered[1]))
#else
#define DUE(i) BELOW_ANSWERED(i)
#endif

#define PASSIVE(i) (IDLE(i) && AGGREGATOR_EMPTY(i) && NOTHING_HELD(i))
/* At work, a rank may answer a probe that is black anyway. In fact it does so only if a rank below is black, or it has
 * received a subdomain itself, which is less. */
#define ANSWERS(i) (PASSIVE(i) || black[i] || token_black)
#if MUTATION == 10  /* a rank that answers at work is not asked for its color */
#define SAYS_BLACK(i) (black[i] && PASSIVE(i))
#else
#define SAYS_BLACK(i) black[i]
#endif

bool busy[N];
byte aggregated[N];     /* SPLITs in the aggregator of a rank */
byte wire[N];           /* work messages under way to a rank */
byte held[N];           /* messages at a rank that wait for their subdomain */
byte work_left = WORK;
byte forwards_left = FORWARDS;

short count[N];         /* sent less handled */
bool black[N];
bool probing;           /* a question of rank 0 is out */
bool answered[N];       /* the question that is out */
short token_count;      /* sum of the answers */
bool token_black;

byte control_wire[N];
byte control_left = CONTROL;
short control[N];       /* sent less received */
bool draining[N];       /* knows that the work is over */
short pass_control;     /* sum of the answers to Terminate */
bool finish;            /* rank 0 has sent Finish */
byte finished;          /* ranks that have seen it */

#define QUIET (!busy[0] && !busy[1] && !busy[2] && \
               aggregated[0] + aggregated[1] + aggregated[2] + wire[0] + wire[1] + wire[2] + \
               held[0] + held[1] + held[2] == 0)
#define CONTROL_QUIET (control_wire[0] + control_wire[1] + control_wire[2] == 0)

inline handle(i) {
  count[i] = count[i] - (1 - HELD);
  black[i] = black[i] || BLACKENS;
  busy[i] = true
}

/* j: any rank but i */
inline any_other(i, j) {
  if
  :: j = (i + 1) % N
  :: j = (i + 2) % N
  fi
}

proctype rank(byte me) {
  byte other;
end:
  do
  /* The program: a SPLIT is made; the work here is done for now. */
  :: atomic { busy[me] && work_left > 0 ->
       work_left--; aggregated[me]++; count[me] = count[me] + ENTERS }
  :: atomic { busy[me] -> busy[me] = false }
  /* The aggregator sends, when it is full or the rank idle: at any time. */
  :: atomic { aggregated[me] > 0 ->
       any_other(me, other); aggregated[me]--; wire[other]++; count[me] = count[me] + LEAVES; other = 0 }
  /* A message arrives: its subdomain is here, has left, or is on its way here. */
  :: atomic { wire[me] > 0 -> wire[me]--; count[me] = count[me] - HELD; handle(me) }
  :: atomic { wire[me] > 0 && forwards_left > 0 ->
       any_other(me, other); wire[me]--; forwards_left--; wire[other]++; count[me] = count[me] + FORWARDED;
       black[me] = COLOUR_AFTER_FORWARDING(me); other = 0 }
  :: atomic { wire[me] > 0 -> wire[me]--; held[me]++; count[me] = count[me] - HELD }
  :: atomic { held[me] > 0 -> held[me]--; handle(me) }
  /* Control messages. */
  :: atomic { control_left > 0 && !draining[me] ->
       any_other(me, other); control_left--; control[me]++; control_wire[other]++; other = 0 }
  :: atomic { control_wire[me] > 0 -> control_wire[me]--; control[me]-- }
  /* A probe: rank 0 asks, the others answer, rank 0 concludes. */
  :: atomic { me == 0 && !probing && !draining[0] ->
       black[0] = false; token_count = 0; token_black = false; probing = true }
  :: atomic { me != 0 && probing && !draining[0] && !answered[me] && DUE(me) && ANSWERS(me) ->
       token_count = token_count + count[me];
       token_black = token_black || SAYS_BLACK(me);
       black[me] = false;
       answered[me] = true }
  :: atomic { me == 0 && probing && !draining[0] && DUE(0) && ANSWERS(0) ->
       answered[1] = false; answered[2] = false;
       if
       :: PASSIVE(0) && !token_black && RANK_0_WHITE && token_count + count[0] == 0 ->
            assert(QUIET);
            draining[0] = true
       :: else -> probing = false
       fi;
       token_count = 0; token_black = false; black[0] = false }
  /* The fence: passes down and up the tree until no control message is under way, then Finish. */
  :: atomic { me != 0 && draining[0] && !finish && !answered[me] ->
       assert(QUIET);
       draining[me] = true;
       if
       :: BELOW_ANSWERED(me) -> pass_control = pass_control + control[me]; answered[me] = true
       :: else
       fi }
  :: atomic { me == 0 && draining[0] && !finish && BELOW_ANSWERED(0) ->
       answered[1] = false; answered[2] = false;
       if
       :: pass_control + control[0] == 0 -> assert(CONTROL_QUIET); finish = true; finished++
       :: else
       fi;
       pass_control = 0 }
  :: atomic { me != 0 && finish ->
       assert(QUIET && CONTROL_QUIET); finished++; break }
  :: me == 0 && finish -> break
  od
}

init {
  atomic {
    byte i;
    for (i : 0 .. N - 1) { busy[i] = true; run rank(i) }
  }
}

/* Where nothing is left to be done or to arrive, the end is found. (Under weak fairness: each rank goes on. That messages
 * arrive at last is the premise, because chance inside a rank is not fair.) */
ltl found { (<> [] (QUIET && CONTROL_QUIET)) -> (<> (finished == N)) }
