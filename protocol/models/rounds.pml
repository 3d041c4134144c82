/* Refinement in rounds with fences, checkpoints, and runs that end at any moment and are gone on with by fewer ranks: a
 * model of runtime/threads/refinement_in_rounds.cpp, job/fence.hpp, job/checkpoints.cpp and distributed/parts_file.cpp
 * (docs/theory.md has the argument in words). tests/models/check_model.cmake runs spin on it.
 *
 * Three subdomains in a row. In the first round each takes STEPS steps; the first step of subdomain 0 puts a point on the
 * border of subdomain 1, and what each does about a point that it is told of, one step, puts one on the border of the
 * next. So a run that nobody stops has three rounds, and ends with the numbers of steps in EXPECTED. What is left out:
 * what a step does to a mesh, which is a function of the state of its subdomain (docs/theory.md), and messages of an
 * exchange among all, which arrive together.
 *
 * MUTATION selects a wrong rule; each must violate an assertion (1, 2, 4) or the formula `ends` (3).
 */
#ifndef RANKS
#define RANKS 3     /* at first; each run that is killed leaves one fewer, but at least one */
#endif
#ifndef KILLS
#define KILLS 2
#endif
#ifndef STEPS
#define STEPS 2
#endif
#ifndef MUTATION
#define MUTATION 0
#endif
#define SUBDOMAINS 3
#define EXPECTED(s) (s == 0 -> STEPS : STEPS + 1)

/* A subdomain: steps that it has taken, that are left in this round, and points that it has to tell after it. */
typedef Subdomain { byte done; byte left; byte told };
Subdomain state[SUBDOMAINS], temporary[SUBDOMAINS], kept[SUBDOMAINS];
byte round = 1, kept_round = 1;
byte owner[SUBDOMAINS];
byte ranks = RANKS;
byte kills = KILLS;
bool over;

/* What a rank does. */
mtype = { works, at_fence, writes, has_written };
mtype does[RANKS];
bool stepped[RANKS];            /* since the last fence */
bool written[SUBDOMAINS];

#define ALIVE(r) (r < ranks)
#define ALL(what) ((!ALIVE(0) || does[0] == what) && (!ALIVE(1) || does[1] == what) && (!ALIVE(2) || does[2] == what))
#define HAS_WORK(r) ((owner[0] == r && state[0].left > 0) || (owner[1] == r && state[1].left > 0) || \
                     (owner[2] == r && state[2].left > 0))
#define RESTS (state[0].left + state[1].left + state[2].left == 0)
#define HAS_WRITTEN(r) ((owner[0] != r || written[0]) && (owner[1] != r || written[1]) && (owner[2] != r || written[2]))
#if MUTATION == 1   /* a checkpoint is complete when rank 0 has written */
#define COMPLETE (does[0] == has_written)
#else
#define COMPLETE ALL(has_written)
#endif
#if MUTATION == 2   /* what is to be told after the round is not kept */
#define KEPT_TOLD(s) 0
#else
#define KEPT_TOLD(s) state[s].told
#endif

#define COPY(from, to, s) \
  to[s].done = from[s].done; to[s].left = from[s].left; to[s].told = from[s].told

inline deal() {
#if MUTATION == 3   /* those of a rank that is gone stay with it */
  owner[0] = 0; owner[1] = 1; owner[2] = 2
#else
  owner[0] = 0; owner[1] = 1 % ranks; owner[2] = 2 % ranks
#endif
}

inline all_do(what) {
  does[0] = what; does[1] = what; does[2] = what;
  stepped[0] = false; stepped[1] = false; stepped[2] = false
}

inline step(s) {
  state[s].left--;
  state[s].done++;
  if
  :: (s == 0 && state[s].done == 1) || (s == 1 && state[s].done > STEPS) -> state[s].told++
  :: else
  fi
}

/* All learn what was told, or the run is over. */
inline end_round() {
  if
  :: state[0].told + state[1].told + state[2].told == 0 ->
       over = true;
       assert(state[0].done == EXPECTED(0) && state[1].done == EXPECTED(1) && state[2].done == EXPECTED(2));
       assert(round == 3)
  :: else ->
       state[1].left = state[1].left + state[0].told;
       state[2].left = state[2].left + state[1].told;
       state[0].told = 0; state[1].told = 0;
       round++
  fi
}

proctype rank(byte me) {
  byte s;
end:
  do
  :: atomic { !over && ALIVE(me) && does[me] == works && HAS_WORK(me) ->
       if
       :: owner[0] == me && state[0].left > 0 -> s = 0
       :: owner[1] == me && state[1].left > 0 -> s = 1
       :: owner[2] == me && state[2].left > 0 -> s = 2
       fi;
       step(s); stepped[me] = true }
  :: atomic { !over && ALIVE(me) && does[me] == works && (stepped[me] || !HAS_WORK(me)) -> does[me] = at_fence }
  :: atomic { !over && ALIVE(me) && does[me] == writes && !HAS_WRITTEN(me) ->
       if
       :: owner[0] == me && !written[0] -> s = 0
       :: owner[1] == me && !written[1] -> s = 1
       :: owner[2] == me && !written[2] -> s = 2
       fi;
       COPY(state, temporary, s); temporary[s].told = KEPT_TOLD(s); written[s] = true }
  :: atomic { !over && ALIVE(me) && does[me] == writes && HAS_WRITTEN(me) -> does[me] = has_written }
  od
}

/* What all do together at a fence. */
proctype fence() {
end:
  do
  :: atomic { !over && ALL(at_fence) ->
       if
       :: all_do(writes); written[0] = false; written[1] = false; written[2] = false
       :: RESTS -> end_round(); all_do(works)
       :: !RESTS -> all_do(works)
       fi }
  :: atomic { !over && COMPLETE && does[0] == has_written ->
       COPY(temporary, kept, 0); COPY(temporary, kept, 1); COPY(temporary, kept, 2);
       kept_round = round;
       if
       :: RESTS -> end_round()
       :: else
       fi;
       all_do(works) }
  od
}

/* The run is killed, and fewer ranks go on from what is kept. */
proctype killer() {
end:
  do
  :: atomic { !over && kills > 0 ->
       kills--;
       ranks = (ranks > 1 -> ranks - 1 : 1);
       COPY(kept, state, 0); COPY(kept, state, 1); COPY(kept, state, 2);
#if MUTATION == 4   /* a subdomain begins anew */
       state[1].done = 0; state[1].left = STEPS; state[1].told = 0;
#endif
       round = kept_round;
       deal();
       all_do(works) }
  od
}

init {
  atomic {
    state[0].left = STEPS; state[1].left = STEPS; state[2].left = STEPS;
    COPY(state, kept, 0); COPY(state, kept, 1); COPY(state, kept, 2);
    deal();
    all_do(works);
    run rank(0); run rank(1); run rank(2); run fence(); run killer()
  }
}

ltl ends { <> over }
