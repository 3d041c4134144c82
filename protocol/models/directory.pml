/* The directory with its forwarding rule, and hand-off: a model of protocol/directory.cpp and of how rank_protocol.hpp
 * uses it (docs/protocol.md has the argument in words). tests/models/check_model.cmake runs spin on it.
 *
 * One subdomain wanders between N ranks. Messages for it start on any rank at any time, hand-offs and location updates
 * take any time, and all overtake each other. Updates go to the rank that a message came from at first, and at any time
 * to anybody from anybody, with what the sender believes; each may arrive any number of times.
 *
 * MUTATION selects a wrong rule; each must violate an assertion.
 */
#ifndef N
#define N 3
#endif
#ifndef MOVES
#define MOVES 3
#endif
#ifndef MESSAGES
#define MESSAGES 2
#endif
#ifndef UPDATES
#define UPDATES 1  /* location updates under way at a time */
#endif
#ifndef MUTATION
#define MUTATION 0
#endif

#if MUTATION == 1  /* records without epochs: the last word wins */
#define SUPERSEDES(news, record) true
#else
#define SUPERSEDES(news, record) (news > record)
#endif
#if MUTATION == 2  /* a message that is ahead of its subdomain is not recognized */
#define HOLDS(r, m) (owner[r] == r)
#else
#define HOLDS(r, m) (owner[r] == r || epoch[r] < m)
#endif
#if MUTATION == 3  /* a forwarded message keeps the epoch of its sender */
#define FORWARDED_WITH(r, m) m
#else
#define FORWARDED_WITH(r, m) epoch[r]
#endif
#if MUTATION == 4  /* the subdomain arrives, and nobody looks at what was held back for it */
#define RELEASES false
#else
#define RELEASES true
#endif

/* What the ranks know. */
byte owner[N];
byte epoch[N];
bool has[N];

/* The truth: the epoch of the last move, and the hand-off under way. */
byte moved;
bool under_way;
byte under_way_to;

mtype = { unsent, sent, waiting, handled };
mtype state[MESSAGES] = unsent;
byte to[MESSAGES];       /* the rank it is on its way to, or waits at */
byte with[MESSAGES];     /* its epoch */
byte origin[MESSAGES];
byte first_with[MESSAGES];
byte hops[MESSAGES];

chan updates = [UPDATES] of { byte, byte, byte };  /* receiver, owner, epoch */

inline learn(r, o, e) {
  if
  :: SUPERSEDES(e, epoch[r]) -> owner[r] = o; epoch[r] = e
  :: else
  fi
}

inline tell(r, o, e) {
  if
  :: nfull(updates) && r != o -> updates!r, o, e
  :: full(updates)
  :: r == o
  fi
}

inline any_rank(r) { select(r : 0 .. N - 1) }
inline any_message(k) { select(k : 0 .. MESSAGES - 1) }

active proctype world() {
  byte r, other, k, o, e, i;
  has[0] = true;
  do
  /* The rank that has the subdomain gives it away. */
  :: atomic { moved < MOVES && !under_way ->
       for (i : 0 .. N - 1) { if :: has[i] -> r = i :: else fi }
       any_rank(other);
       if
       :: other != r ->
            moved++; has[r] = false; owner[r] = other; epoch[r]++;
            assert(epoch[r] == moved);
            under_way = true; under_way_to = other
       :: else
       fi;
       r = 0; other = 0; i = 0 }
  /* It arrives. */
  :: atomic { under_way ->
       r = under_way_to;
       assert(!has[r] && (epoch[r] < moved || (epoch[r] == moved && owner[r] == r)));
       under_way = false; has[r] = true; owner[r] = r; epoch[r] = moved;
       for (k : 0 .. MESSAGES - 1) {
         if :: state[k] == waiting && RELEASES -> assert(to[k] == r); state[k] = handled; to[k] = 0 :: else fi
       }
       under_way_to = 0; r = 0; k = 0 }
  /* A rank has something to say to it. */
  :: atomic { state[0] == unsent || state[MESSAGES - 1] == unsent ->
       any_message(k); any_rank(r);
       if
       :: state[k] == unsent && has[r] -> state[k] = handled
       :: state[k] == unsent && !has[r] ->
            state[k] = sent; origin[k] = r; to[k] = owner[r]; with[k] = epoch[r]; first_with[k] = epoch[r]
       :: else
       fi;
       r = 0; k = 0 }
  /* A message arrives at a rank. */
  :: atomic { state[0] == sent || state[MESSAGES - 1] == sent ->
       any_message(k);
       if
       :: state[k] == sent ->
            r = to[k];
            if
            :: has[r] -> state[k] = handled; to[k] = 0
            :: !has[r] && HOLDS(r, with[k]) -> assert(under_way && under_way_to == r); state[k] = waiting
            :: !has[r] && !HOLDS(r, with[k]) ->
                 assert(owner[r] != r);
                 tell(origin[k], owner[r], epoch[r]);
                 to[k] = owner[r];
                 with[k] = FORWARDED_WITH(r, with[k]);
                 hops[k]++;
                 assert(hops[k] <= moved - first_with[k]);  /* no cycle */
                 assert(hops[k] <= with[k])                 /* what each receiver asks */
            fi
       :: else
       fi;
       r = 0; k = 0 }
  /* An update arrives, perhaps not for the last time. */
  :: atomic { nempty(updates) ->
       if
       :: updates ?? r, o, e
       :: updates ?? <r, o, e>
       fi;
       learn(r, o, e); r = 0; o = 0; e = 0 }
  /* Somebody says what it believes. */
  :: atomic { nfull(updates) && state[0] != handled ->
       any_rank(r); any_rank(other);
       tell(other, owner[r], epoch[r]); r = 0; other = 0 }
  /* All is said and done. */
  :: atomic { moved == MOVES && !under_way && empty(updates) ->
       for (k : 0 .. MESSAGES - 1) { if :: state[k] == waiting -> assert(false) :: else fi }
       k = 0 }
  od
}
