#pragma once

#include <limits>

namespace driftmesh {

/// Detects when nothing moves for too long. Pure: time is an argument.
class Watchdog {
 public:
  /// Triggers after this many seconds without movement, and again after as many more.
  explicit Watchdog(double patience) : patience_(patience) {}

  void moved(double now) { since_ = last_bark_ = now; }
  /// Whether it is time to say that nothing has moved for quiet(now) seconds.
  [[nodiscard]] bool barks(double now) {
    if (since_ == kNever) moved(now);
    if (now - last_bark_ < patience_) return false;
    last_bark_ = now;
    return true;
  }
  [[nodiscard]] double quiet(double now) const { return now - since_; }

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  double patience_;
  double since_ = kNever;
  double last_bark_ = kNever;
};

}  // namespace driftmesh
