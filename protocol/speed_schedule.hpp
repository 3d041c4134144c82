#pragma once

#include <vector>

namespace driftmesh::protocol {

/// From `at` on, in seconds, a rank has this fraction of its speed; 0: it is not there.
struct SpeedChange {
  double at = 0;
  double factor = 1;
};

/// The speed of a simulated rank over time, in steps: 1 until the first change.
class SpeedSchedule {
 public:
  SpeedSchedule() = default;
  /// Throws Error unless times ascend from 0 on, factors are finite and not negative, and the last one is above 0, so
  /// that all work ends.
  explicit SpeedSchedule(const std::vector<SpeedChange>& changes);

  /// When work that begins at `start` is done, if it takes `seconds` at full speed.
  [[nodiscard]] double end_of(double start, double seconds) const;
  /// The seconds at full speed that pass from the start of the run to `time`.
  [[nodiscard]] double done_by(double time) const;
  /// The first moment from `time` on at which the rank is there.
  [[nodiscard]] double present_from(double time) const;

 private:
  std::vector<SpeedChange> steps_ = {{0, 1}};  // the first at 0
};

}  // namespace driftmesh::protocol
