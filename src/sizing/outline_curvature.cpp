#include "sizing/outline_curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "driftmesh/error.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/nearest_in_square.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kFewestArcs = 1;  // fewer are not worth their memory
constexpr std::size_t kFewArcs = 48;

/// 1 over the radius of the circle through three points: four times the area of their triangle over the product of its
/// sides.
double curvature_through(const Point& p, const Point& q, const Point& r) {
  const double twice_area = std::fabs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
  const double sides =
      std::sqrt(squared_distance(p, q)) * std::sqrt(squared_distance(q, r)) * std::sqrt(squared_distance(r, p));
  return sides > 0 ? 2 * twice_area / sides : 0;
}

/// At each end of each segment.
std::vector<std::array<double, 2>> curvatures_of(const OutlineSegments& outline) {
  using Key = std::pair<double, double>;
  std::map<Key, std::vector<Point>> others;  // ends of the segments at a point
  for (const auto& [a, b] : outline) {
    others[{a.x, a.y}].push_back(b);
    others[{b.x, b.y}].push_back(a);
  }
  const auto at = [&](const Point& p) {
    const std::vector<Point>& around = others[{p.x, p.y}];
    return around.size() == 2 ? curvature_through(around[0], p, around[1]) : 0;
  };
  std::vector<std::array<double, 2>> found;
  for (const auto& [a, b] : outline) found.push_back({at(a), at(b)});
  return found;
}

}  // namespace

OutlineCurvature::OutlineCurvature(OutlineSegments outline) {
  if (outline.empty()) throw Error("no outline to measure the curvature of");
  sort_segments(outline);
  std::vector<Box> boxes;
  Box box;
  for (const auto& [a, b] : outline) {
    boxes.push_back(Box::around(a, b));
    box.extend(boxes.back());
  }
  All all;
  all.tree = BoxTree(boxes);
  all.least = 1e-6 / (2 * half_diagonal(box));
  all.most = all.least;
  all.margin = margin_in(box);
  const std::vector<std::array<double, 2>> curvatures = curvatures_of(outline);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double at_a = std::max(curvatures[i][0], all.least), at_b = std::max(curvatures[i][1], all.least);
    all.arcs.push_back({outline[i].a, outline[i].b, at_a, at_b});
    all.most = std::max({all.most, at_a, at_b});
  }
  all_ = std::make_shared<const All>(std::move(all));
}

double OutlineCurvature::squared_to(const Point& p, std::int32_t item) const {
  const Arc& arc = all_->arcs[item];
  return std::max(squared_distance_to_segment(p, arc.a, arc.b), Box::around(arc.a, arc.b).squared_distance(p));
}

/// The first among equals.
std::int32_t OutlineCurvature::nearest(const Point& p) const {
  const auto distance = [&](std::int32_t item) { return squared_to(p, item); };
  return few_.empty() ? all_->tree.nearest(p, distance) : *std::ranges::min_element(few_, {}, distance);
}

double OutlineCurvature::at(const Point& p) const {
  const Arc& arc = all_->arcs[nearest(p)];
  return arc.at_a + nearest_on_segment(p, arc.a, arc.b) * (arc.at_b - arc.at_a);
}

/// Those that can be nearest in a box, up to one more than `most`.
std::vector<std::int32_t> OutlineCurvature::candidates(const Box& box, std::size_t most) const {
  const std::int32_t rival = nearest(box.center());
  const auto square = NearestInSquare::against(
      box, [&](const Point& p) { return std::sqrt(squared_to(p, rival)); }, all_->margin);
  std::vector<std::int32_t> found;
  const auto visit = [&](std::int32_t item) {
    const Arc& arc = all_->arcs[item];
    const Point foot = nearest_point_on_segment(square.center(), arc.a, arc.b);
    if (found.size() <= most && square.needs(foot, arc.a, arc.b)) found.push_back(item);
  };
  if (few_.empty())
    all_->tree.search([&](const Box& around) { return found.size() <= most && square.needs(0, around); }, visit);
  else
    std::ranges::for_each(few_, visit);
  std::ranges::sort(found);
  return found;
}

Variation OutlineCurvature::over(const Box& box) const {
  using intervals::kAll;
  const Variation any{{all_->least, all_->most}, kAll, kAll, kAll};
  if (few_.empty() || !std::isfinite(squared_distance(box.low, box.high))) return any;
  const std::vector<std::int32_t> found = candidates(box, few_.size());
  const Point center = box.center(), half{(box.high.x - box.low.x) / 2, (box.high.y - box.low.y) / 2};
  Interval value{all_->most, all_->least}, in_x{0, 0}, in_y{0, 0};
  for (const std::int32_t item : found) {
    const Arc& arc = all_->arcs[item];
    const Point d{arc.b.x - arc.a.x, arc.b.y - arc.a.y};
    const double square = d.x * d.x + d.y * d.y;
    const double middle = ((center.x - arc.a.x) * d.x + (center.y - arc.a.y) * d.y) / square;
    const double reach = (half.x * std::fabs(d.x) + half.y * std::fabs(d.y)) / square;
    const double rounding = all_->margin / std::sqrt(square);
    const auto curvature_at = [&](double t) { return arc.at_a + std::clamp(t, 0.0, 1.0) * (arc.at_b - arc.at_a); };
    const auto [low, high] =
        std::minmax({curvature_at(middle - reach - rounding), curvature_at(middle + reach + rounding)});
    value = {std::min(value.low, low), std::max(value.high, high)};
    const double rise = (arc.at_b - arc.at_a) / square;
    in_x = intervals::outward(std::min(rise * d.x, 0.0), std::max(rise * d.x, 0.0));
    in_y = intervals::outward(std::min(rise * d.y, 0.0), std::max(rise * d.y, 0.0));
  }
  if (value.is_point()) return {value, {0, 0}, {0, 0}, {0, 0}};
  value = intervals::outward(value.low, value.high);
  if (found.size() > 1) return {value, kAll, kAll, kAll};
  const double steepest = std::hypot(std::max(-in_x.low, in_x.high), std::max(-in_y.low, in_y.high));
  return {value, in_x, in_y, intervals::outward(-steepest, steepest)};
}

std::shared_ptr<const PlaneFunction> OutlineCurvature::within(const Box& box) const {
  if (!few_.empty() && few_.size() <= kFewestArcs) return nullptr;
  std::vector<std::int32_t> found = candidates(box, kFewArcs);
  if (found.size() > kFewArcs || found.size() == few_.size()) return nullptr;
  auto narrowed = std::make_shared<OutlineCurvature>(*this);
  narrowed->few_ = std::move(found);
  return narrowed;
}

}  // namespace driftmesh
