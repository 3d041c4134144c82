#pragma once

#include <cmath>

namespace driftmesh::balancer {

/// A rank's speed as a running average: what was done `memory` seconds ago counts 1/e of what is done now.
class SpeedEstimate {
 public:
  explicit SpeedEstimate(double memory = 2) : memory_(memory) {}

  /// `triangles` were made in `seconds` of the rank's time, whatever else used the processor meanwhile. Idle time does
  /// not belong here.
  void add(double triangles, double seconds) {
    if (seconds <= 0) return;
    const double kept = std::exp(-seconds / memory_);
    triangles_ = triangles_ * kept + triangles;
    seconds_ = seconds_ * kept + seconds;
    observed_ += seconds;
  }

  /// Triangles a second; 0 while too little was seen to say.
  [[nodiscard]] double value() const { return observed_ < kEnough || triangles_ <= 0 ? 0 : triangles_ / seconds_; }

 private:
  static constexpr double kEnough = 0.02;  // seconds

  double memory_;
  double triangles_ = 0;
  double seconds_ = 0;
  double observed_ = 0;
};

}  // namespace driftmesh::balancer
