#pragma once

#include <map>
#include <span>

#include "balancer/snapshot/messages.hpp"

namespace driftmesh::balancer {

/// Triangles that could be made in the time that it takes to start a subdomain, besides its own (see CostModel): of
/// small subdomains it is much of the work. Fewer where each triangle stands for many.
inline constexpr double kWorkToStart = 250;

/// The expected rest of a number with this expectation and standard deviation, normally distributed, that is known to
/// exceed `made`: about the difference while much is missing, and still a fraction of the deviation beyond that.
[[nodiscard]] double expected_rest(double expected, double deviation, double made);

/// What a rank learns from the subdomains that it finishes about those that are left: by how much forecasts are wrong,
/// and how much the time for the work forecast varies. Subdomains on segments of the input and those without any are
/// told apart, since forecasts err in different ways there. With little experience, forecasts are trusted: each ratio
/// is that of a sum to which a few subdomains have been added that behave as expected.
class Experience {
 public:
  /// Starting a subdomain takes as long as that many triangles.
  explicit Experience(double work_to_start = kWorkToStart) : work_to_start_(work_to_start) {}

  /// A subdomain was refined for that long; `started`: for the first time.
  void worked(SubdomainId id, double seconds, bool started);
  /// It met its bounds for the first time, and had been started with that forecast. Ignored if it was started
  /// elsewhere: nobody here knows how long that took.
  void finished(SubdomainId id, bool on_segments, double forecast, double made);
  /// It has gone to another rank.
  void left(SubdomainId id) { seconds_.erase(id); }

  /// Triangles made over triangles forecast, of subdomains that are not finished.
  [[nodiscard]] double ratio(bool on_segments) const;
  /// Work left in an unfinished subdomain: triangles still to be made, and its start if it has made none.
  [[nodiscard]] double rest(bool on_segments, double forecast, double made) const;
  /// The standard deviation of the time that one subdomain takes over its forecast work, relative to the mean.
  [[nodiscard]] double variation() const;
  /// The same of the time for this load: what is uncertain is each subdomain, and the speed.
  [[nodiscard]] double doubt(std::span<const ReportedLoad> own) const;

 private:
  struct Sums {
    double count = 0, forecast = 0, made = 0, pace = 0, pace_squared = 0;  // pace: seconds over work forecast
    Sums& operator+=(const Sums& s);
    [[nodiscard]] double ratio(double supposed, double triangles) const;
    [[nodiscard]] double square_deviations() const;
  };
  [[nodiscard]] Sums all() const;

  double work_to_start_;
  std::map<SubdomainId, double> seconds_;  // spent on those started here and not finished
  Sums inside_, on_segments_;
};

}  // namespace driftmesh::balancer
