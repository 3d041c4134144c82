#include "base/noted_signals.hpp"

namespace driftmesh {

// Signals do there what they do by default: a run that is told to end ends, and its last checkpoint stays.

NotedSignals::NotedSignals() = default;
NotedSignals::~NotedSignals() = default;

bool NotedSignals::told_to_end() {
  return false;
}

bool NotedSignals::requested() {
  return false;
}

void NotedSignals::forget_request() {}

void NotedSignals::have_met() {}

}  // namespace driftmesh
