#include "balancer/snapshot/experience.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftmesh::balancer {
namespace {

/// What is supposed before there is any experience, as if this many subdomains had shown it.
constexpr double kSupposed = 2;
constexpr double kSupposedVariation = 0.1;

}  // namespace

double expected_rest(double expected, double deviation, double made) {
  constexpr double kFar = 6;  // deviations
  if (expected - made >= kFar * deviation) return expected - made;
  if (deviation <= 0) return 0;
  const double u = std::min((made - expected) / deviation, kFar);
  const double hazard = std::sqrt(2 / std::numbers::pi) * std::exp(-u * u / 2) / std::erfc(u / std::numbers::sqrt2);
  return deviation * (hazard - u);
}

Experience::Sums& Experience::Sums::operator+=(const Sums& s) {
  count += s.count;
  forecast += s.forecast;
  made += s.made;
  pace += s.pace;
  pace_squared += s.pace_squared;
  return *this;
}

/// With some subdomains of so many triangles added that have the supposed ratio.
double Experience::Sums::ratio(double supposed, double triangles) const {
  const double added = kSupposed * triangles;
  return (added * supposed + made) / (added + forecast);
}

/// Squared deviations of the paces, summed, over the square of their mean.
double Experience::Sums::square_deviations() const {
  return pace > 0 ? std::max(0.0, count * (count * pace_squared / (pace * pace) - 1)) : 0;
}

Experience::Sums Experience::all() const {
  Sums sums = inside_;
  return sums += on_segments_;
}

void Experience::worked(SubdomainId id, double seconds, bool started) {
  if (started) seconds_[id] = 0;
  if (const auto known = seconds_.find(id); known != seconds_.end()) known->second += seconds;
}

void Experience::finished(SubdomainId id, bool on_segments, double forecast, double made) {
  const auto node = seconds_.extract(id);
  if (node.empty() || forecast <= 0 || node.mapped() <= 0) return;
  const double pace = node.mapped() / (work_to_start_ + forecast);
  (on_segments ? on_segments_ : inside_) += {1, forecast, made, pace, pace * pace};
}

double Experience::ratio(bool on_segments) const {
  const Sums sums = all();
  if (sums.count == 0) return 1;
  const double triangles = sums.forecast / sums.count;
  return (on_segments ? on_segments_ : inside_).ratio(sums.ratio(1, triangles), triangles);
}

double Experience::rest(bool on_segments, double forecast, double made) const {
  const double expected = forecast * ratio(on_segments);
  return (made > 0 ? 0 : work_to_start_) + expected_rest(expected, variation() * expected, made);
}

double Experience::variation() const {
  const double supposed = kSupposed * kSupposedVariation * kSupposedVariation;
  const double seen = inside_.square_deviations() + on_segments_.square_deviations();
  return std::sqrt((supposed + seen) / (kSupposed + all().count));
}

double Experience::doubt(std::span<const ReportedLoad> own) const {
  double sum = 0, squares = 0;
  for (const ReportedLoad& load : own) {
    sum += load.remaining;
    squares += load.remaining * load.remaining;
  }
  return sum > 0 ? variation() * std::sqrt(squares / (sum * sum) + 1 / (kSupposed + all().count)) : 0;
}

}  // namespace driftmesh::balancer
