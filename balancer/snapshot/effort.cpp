#include "balancer/snapshot/effort.hpp"

#include <algorithm>
#include <cmath>

namespace driftmesh::balancer {
namespace {

thread_local EffortLog* innermost = nullptr;

}  // namespace

EffortLog::EffortLog() : outer_(innermost) {
  innermost = this;
}

EffortLog::~EffortLog() {
  innermost = outer_;
}

void note_effort(const char* kind, double units) {
  if (innermost != nullptr) innermost->efforts_[kind] += units;
}

double bisections(std::size_t parts) {
  return std::max(1.0, std::log2(static_cast<double>(parts)));
}

double PlanningCosts::seconds(const Efforts& efforts) const {
  double seconds = 0;
  for (const auto& [kind, units] : efforts)
    if (const auto cost = unit.find(kind); cost != unit.end()) seconds += units * cost->second;
  return seconds;
}

}  // namespace driftmesh::balancer
