#pragma once

#include <algorithm>

#include "balancer/trigger/controller_options.hpp"

namespace driftmesh::balancer {

/// When a planner plans again: not at once, at growing intervals while nothing comes of it, and never so often that
/// planning takes more than its share of the time.
class PlanningPace {
 public:
  PlanningPace(const ControllerOptions& options, double now)
      : gap_(options.gap), interval_(options.interval), overhead_(options.overhead), next_(now), pause_(options.gap) {}

  [[nodiscard]] bool due(double now) const { return now >= next_; }

  /// The planner checked whether there is something to gain.
  void looked(double now) {
    looked_ = now;
    planned_ = false;
    next_ = now + gap_;
  }
  /// It also made a plan.
  void planned(double now, bool moves) {
    looked_ = now;
    planned_ = true;
    pause_ = moves ? gap_ : std::min(2 * pause_, interval_);
    next_ = now + pause_;
  }
  /// The duration of the last action.
  void took(double seconds) {
    next_ = std::max(next_, looked_ + seconds / overhead_);
    if (planned_) cost_ = seconds;
  }

  /// Seconds that the last plan took.
  [[nodiscard]] double cost_of_planning() const { return cost_; }

 private:
  double gap_, interval_, overhead_;
  double next_;
  double pause_;  // wait after a plan without effect
  double looked_ = 0;
  bool planned_ = false;  // at the last check
  double cost_ = 0;
};

}  // namespace driftmesh::balancer
