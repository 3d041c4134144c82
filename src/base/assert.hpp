#pragma once

#include <cstdio>
#include <cstdlib>

/// DM_ASSERT(condition): an invariant of the program, checked in debug and release-checked builds, absent otherwise.
/// It never guards against bad input: that is an InputError, in every build.
#ifdef DRIFTMESH_CHECKED
#define DM_ASSERT(condition)                                                                 \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: invariant broken: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#else
#define DM_ASSERT(condition) \
  do {                       \
  } while (false && (condition))
#endif
