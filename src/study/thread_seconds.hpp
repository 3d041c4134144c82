#pragma once

#include <ctime>

namespace driftmesh::study {

/// CPU time of this thread: other programs disturb it little.
[[nodiscard]] inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace driftmesh::study
