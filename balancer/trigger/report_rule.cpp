#include "balancer/trigger/report_rule.hpp"

#include <algorithm>
#include <cmath>

namespace driftmesh::balancer {

bool ReportRule::due(double now, double remaining, double speed, bool changed) const {
  // A rank with work but unknown speed has little to report.
  if (!last_) return speed > 0 || remaining <= 0;
  const double elapsed = now - last_->now;
  if (elapsed < gap_) return false;
  return changed || (remaining > 0 && elapsed >= interval_) || surprising(elapsed, remaining, speed);
}

bool ReportRule::surprising(double elapsed, double remaining, double speed) const {
  const bool has_finished = remaining <= 0 && last_->remaining > 0;
  const bool has_work_again = remaining > 0 && last_->remaining <= 0;
  if (has_finished || has_work_again) return true;
  if (speed <= 0 || last_->speed <= 0) return false;
  const double left = last_->remaining / last_->speed;
  const double expected = std::max(0.0, left - elapsed);
  return std::abs(remaining / speed - expected) > change_ * left;
}

}  // namespace driftmesh::balancer
