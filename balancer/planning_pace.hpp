#pragma once

#include <algorithm>

#include "balancer/conduct.hpp"

namespace driftmesh::balancer {

/// When a rank that plans does so again: not at once, later and later while nothing comes of it, and never so often
/// that planning takes more than its share of the time.
class PlanningPace {
 public:
  PlanningPace(const ControllerOptions& options, double now)
      : gap_(options.gap), interval_(options.interval), overhead_(options.overhead), next_(now), pause_(options.gap) {}

  [[nodiscard]] bool due(double now) const { return now >= next_; }

  /// Whether there is something to gain was looked at.
  void looked(double now) {
    looked_ = now;
    planned_ = false;
    next_ = now + gap_;
  }
  /// A plan was made as well.
  void planned(double now, bool moves) {
    looked_ = now;
    planned_ = true;
    pause_ = moves ? gap_ : std::min(2 * pause_, interval_);
    next_ = now + pause_;
  }
  /// What was done last took that long, waiting for others included: it is time lost to all.
  void took(double seconds) {
    next_ = std::max(next_, looked_ + seconds / overhead_);
    if (planned_) cost_ = seconds;
  }

  /// Seconds that the last plan took.
  [[nodiscard]] double cost_of_planning() const { return cost_; }

 private:
  double gap_, interval_, overhead_;
  double next_;
  double pause_;  // after a plan of which nothing came
  double looked_ = 0;
  bool planned_ = false;  // when it looked last
  double cost_ = 0;
};

}  // namespace driftmesh::balancer
