#pragma once

#include <chrono>
#include <thread>

namespace driftmesh::job {

/// Slows a rank down on purpose: after this many seconds of work it sleeps long enough to work only the fraction
/// `share` (above 0, at most 1) of the time.
inline void drag(double share, double seconds) {
  if (share < 1) std::this_thread::sleep_for(std::chrono::duration<double>(seconds * (1 / share - 1)));
}

}  // namespace driftmesh::job
