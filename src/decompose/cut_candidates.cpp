#include "decompose/cut_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "base/wide.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// The length of a compact subdomain's border over the square root of its area, as measured for good decompositions.
constexpr double kPerimeter = 4.1;

/// What it is worth, in the border of a subdomain, that a separator ends where one on the other side of a wall does:
/// there are four neighbors around the place then, and one interface less than around two places.
constexpr double kCrossing = 0.02;

/// The total border length of the `parts` subdomains that a piece will be cut into: compact ones, or slices if the
/// piece is long and thin.
double expected_border(double area, double length, std::int32_t parts) {
  const double compact = kPerimeter * std::sqrt(area * parts);
  const double slices = length + 4 * (parts - 1) * area / length;
  const double longer = std::max(compact, slices);
  return parts == 1 ? length : longer;
}

/// The cost of a deviation from the mean work, in units of the expected border.
double imbalance_cost(double load) {
  const double over = std::max(0.0, load - 1.25);
  return 0.3 * (load - 1) * (load - 1) + 8 * over * over;
}

/// The number of `n` parts that is nearest to a share of them; at least one is on each side.
std::int32_t nearest_parts(double share, std::int32_t n) {
  const double beyond = share * n + 0.5;  // std::lround would not become a vector instruction
  return std::min(std::max(static_cast<std::int32_t>(beyond), 1), n - 1);
}

struct Sides {
  const double *squared_length, *border, *area, *share, *opposite;
};

DRIFTMESH_WIDE void set_costs(const Sides& sides, std::size_t count, const Outline& outline, const CutGoal& goal,
                              std::int32_t* parts, double* cost) {
  const std::int32_t n = goal.parts;
  const double load = goal.load, bias = goal.bias, whole_area = outline.area, whole_length = outline.length;
  const double unit = kPerimeter * std::sqrt(whole_area * n);
  const auto [squared_length, border, area, shares, opposite] = sides;
  for (std::size_t k = 0; k < count; ++k) {
    const double share = shares[k];
    // the share of the parts that corresponds to this share of the work
    const double fair = share / (share + bias * (1 - share));
    const std::int32_t between = nearest_parts(fair, n), rest = n - between;
    const double length = std::sqrt(squared_length[k]);
    const double expected = expected_border(area[k], border[k] + length, between) +
                            expected_border(whole_area - area[k], whole_length - border[k] + length, rest);
    const double depth = 1 - 2.0 * std::min(between, rest) / n;
    parts[k] = between;
    const double sum = (expected + 0.3 * length) / unit + imbalance_cost(load * fair * n / between) +
                       imbalance_cost(load * (1 - fair) * n / rest) + 0.1 * depth * depth - kCrossing / n * opposite[k];
    cost[k] = share > 0 && share < 1 && sum < CutCandidates::kNever
                  ? sum
                  : CutCandidates::kNever;  // not a number if the area is below 0
  }
}

}  // namespace

void CutCandidates::measure(const Outline& outline) {
  const std::size_t count = pairs_.size();
  for (auto* column : {&length_, &border_, &area_, &share_, &opposite_, &cost_}) column->resize(count);
  parts_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Outline::Station &a = outline.stations[pairs_[k].first], &b = outline.stations[pairs_[k].second];
    length_[k] = squared_distance(a.at, b.at);
    opposite_[k] = static_cast<double>(a.opposite + b.opposite);
    border_[k] = b.length - a.length;
    area_[k] = outline.twice_area_between(a, b) / 2;
  }
}

void CutCandidates::rank(const Outline& outline, const CutGoal& goal) {
  measure(outline);
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    share_[k] = outline.samples.empty()
                    ? area_[k] / outline.area
                    : outline.sampled_share(outline.stations[pairs_[k].first], outline.stations[pairs_[k].second]);
  set_costs({length_.data(), border_.data(), area_.data(), share_.data(), opposite_.data()}, pairs_.size(), outline,
            goal, parts_.data(), cost_.data());
}

std::size_t CutCandidates::cheapest() const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < cost_.size(); ++k) best = cost_[k] < cost_[best] ? k : best;
  return best;
}

void CutCandidates::make_heap() {
  heap_.clear();
  for (std::uint32_t k = 0; k < cost_.size(); ++k)
    if (cost_[k] < CutCandidates::kNever) heap_.push_back(k);
  std::ranges::make_heap(heap_, [this](std::uint32_t k, std::uint32_t l) { return worse(k, l); });
}

void CutCandidates::pop_heap() {
  std::ranges::pop_heap(heap_, [this](std::uint32_t k, std::uint32_t l) { return worse(k, l); });
  heap_.pop_back();
}

}  // namespace driftmesh
