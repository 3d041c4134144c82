#pragma once

#include <cmath>

namespace driftmesh::balancer {

/// A rank's speed as a running average: work done `memory` seconds ago has 1/e of the weight of current work.
class SpeedEstimate {
 public:
  explicit SpeedEstimate(double memory = 2) : memory_(memory) {}

  /// Result of a slice of work on a subdomain.
  struct Slice {
    double triangles = 0;   ///< made
    double seconds = 0;     ///< of the rank's wall-clock time, whatever else used the processor
    bool prepared = false;  ///< the subdomain was started in it
    bool finished = false;  ///< the subdomain was finished in it
  };

  /// Idle time does not belong here.
  void add(const Slice& slice) {
    if (slice.seconds <= 0) return;
    if (slice.prepared) preparing_ += slice.seconds;
    finished_ = finished_ || slice.finished;
    const double kept = std::exp(-slice.seconds / memory_);
    triangles_ = triangles_ * kept + slice.triangles;
    seconds_ = seconds_ * kept + slice.seconds;
    observed_ += slice.seconds;
  }

  /// Triangles per second; 0 while there is too little data: too short a time, or only the start of a subdomain, which
  /// takes time but makes few triangles. A slow rank spends more time on that, and would seem slower than it is.
  [[nodiscard]] double value() const {
    const bool whole = finished_ || preparing_ <= kPreparing * observed_;
    return observed_ < kEnough || !whole || triangles_ <= 0 ? 0 : triangles_ / seconds_;
  }

 private:
  static constexpr double kEnough = 0.02;    // seconds
  static constexpr double kPreparing = 0.1;  // fraction of the time

  double memory_;
  double triangles_ = 0;
  double seconds_ = 0;
  double observed_ = 0;
  double preparing_ = 0;
  bool finished_ = false;
};

}  // namespace driftmesh::balancer
