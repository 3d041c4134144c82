#pragma once

#include <algorithm>
#include <cmath>

namespace driftmesh::balancer {

/// A rank's speed as a running average: work done `memory` seconds ago has 1/e of the weight of current work.
///
/// The start of a subdomain takes time and makes few triangles. Counted when it occurs, it would make a rank seem slow
/// just then, and work would move about for nothing. So it is spread over all triangles that the subdomain will have.
class SpeedEstimate {
 public:
  explicit SpeedEstimate(double memory = 2) : memory_(memory) {}

  /// Result of a slice of work on a subdomain.
  struct Slice {
    double triangles = 0;  ///< made
    double seconds = 0;    ///< wall-clock time of the rank, whatever else used the processor
    double started = 0;    ///< triangles that the subdomain will have, if it was started in this slice
  };

  /// Idle time does not belong here.
  void add(const Slice& slice) {
    if (slice.seconds <= 0) return;
    observed_ += slice.seconds;
    const double kept = std::exp(-slice.seconds / memory_);
    all_.fade(kept);
    refining_.fade(kept);
    all_.add(slice);
    if (slice.started > 0) {
      starting_.fade(kKept);
      starting_.add(slice);
      will_have_ = will_have_ * kKept + slice.started;
    } else {
      refining_.add(slice);
    }
  }

  /// Triangles per second; 0 while there is too little data.
  [[nodiscard]] double value() const {
    if (observed_ < kEnough) return 0;
    // With small subdomains most slices start one, and there is nothing to tell apart.
    if (refining_.seconds < kRefining * all_.seconds)
      return will_have_ < kFewStarts * starting_.triangles ? all_.speed() : 0;
    const double speed = refining_.speed();
    if (speed <= 0 || will_have_ <= 0) return speed;
    const double start = std::max(0.0, starting_.seconds - starting_.triangles / speed) / will_have_;
    return 1 / (1 / speed + start);
  }

 private:
  static constexpr double kEnough = 0.02;   // seconds
  static constexpr double kRefining = 0.1;  // share of the time
  static constexpr double kFewStarts = 2;
  static constexpr double kKept = 0.9;  // weight of the starts before the last one

  struct Sum {
    double triangles = 0;
    double seconds = 0;

    void add(const Slice& slice) { triangles += slice.triangles, seconds += slice.seconds; }
    void fade(double kept) { triangles *= kept, seconds *= kept; }
    [[nodiscard]] double speed() const { return triangles > 0 ? triangles / seconds : 0; }
  };

  double memory_;
  Sum all_, refining_;  // recent slices weigh most
  Sum starting_;
  double will_have_ = 0;  // triangles of the subdomains whose start is in starting_
  double observed_ = 0;
};

}  // namespace driftmesh::balancer
