#include "sizing/segment_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "driftmesh/error.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/nearest_in_square.hpp"

namespace driftmesh {
namespace {

using Ends = SegmentDistance::Ends;
using Line = SegmentDistance::Line;

constexpr std::size_t kFewest = 4;  // fewer are not worth their memory
constexpr std::size_t kFew = 48;

std::vector<Ends> segments_with(const Pslg& pslg, std::span<const std::int32_t> markers) {
  std::vector<Ends> segments;
  for (const Pslg::Segment& s : pslg.segments) {
    if (!markers.empty() && std::ranges::find(markers, s.marker) == markers.end()) continue;
    segments.push_back({pslg.points[s.a], pslg.points[s.b]});
  }
  if (segments.empty()) throw Error("no segments to measure the distance to");
  return segments;
}

std::vector<Box> boxes_of(const std::vector<Ends>& segments) {
  std::vector<Box> boxes(segments.size());
  std::ranges::transform(segments, boxes.begin(), [](const Ends& s) { return Box::around(s.a, s.b); });
  return boxes;
}

Line line_of(const Ends& s) {
  const double length = std::sqrt(squared_distance(s.a, s.b));
  return {s.a, length > 0 ? Point{(s.b.x - s.a.x) / length, (s.b.y - s.a.y) / length} : Point{}, length};
}

Point nearest_on(const Line& s, const Point& p) {
  const double along = (p.x - s.from.x) * s.direction.x + (p.y - s.from.y) * s.direction.y;
  const double t = std::clamp(along, 0.0, s.length);
  return {s.from.x + t * s.direction.x, s.from.y + t * s.direction.y};
}

double squared_to(const Point& p, const Line& s) {
  return squared_distance(p, nearest_on(s, p));
}

bool may_be_nearest(const NearestInSquare& square, const Line& s) {
  const Point end{s.from.x + s.length * s.direction.x, s.from.y + s.length * s.direction.y};
  return square.needs(nearest_on(s, square.center()), s.from, end);
}

/// Of the distance to a segment, at the points of a box.
DirectionRange slopes_of(const Line& s, const Box& box, double radius) {
  const Point center = box.center();
  const double dx = center.x - s.from.x, dy = center.y - s.from.y;
  const double half_x = (box.high.x - box.low.x) / 2, half_y = (box.high.y - box.low.y) / 2;
  const Point& along = s.direction;
  const double place = dx * along.x + dy * along.y, reach = half_x * std::fabs(along.x) + half_y * std::fabs(along.y);
  if (s.length > 0 && place >= reach && place + reach <= s.length) {  // nearest is always a point between the ends
    const Point normal{-along.y, along.x};
    const double beside = dx * normal.x + dy * normal.y;
    const double across = half_x * std::fabs(normal.x) + half_y * std::fabs(normal.y);
    const double low = beside < across ? -1 : 1, high = beside > -across ? 1 : -1;
    const auto [low_x, high_x] = std::minmax({low * normal.x, high * normal.x});
    const auto [low_y, high_y] = std::minmax({low * normal.y, high * normal.y});
    return {low_x, high_x, low_y, high_y};
  }
  const Point nearest = nearest_on(s, center);
  const double distance = std::sqrt(squared_distance(center, nearest));
  return directions_around({(center.x - nearest.x) / distance, (center.y - nearest.y) / distance}, radius, distance);
}

}  // namespace

struct SegmentDistance::All {
  explicit All(std::vector<Ends> given) : segments(std::move(given)), tree(boxes_of(segments)) {
    for (const Ends& s : segments) lines.push_back(line_of(s));
    for (const Ends& s : segments) box.extend(Box::around(s.a, s.b));
    extent = 2 * half_diagonal(box);
    margin = margin_in(box);
  }
  std::vector<Ends> segments;
  std::vector<Line> lines;
  BoxTree tree;
  Box box;
  double extent;  // diagonal of the box around all segments
  double margin = 0;
};

SegmentDistance::SegmentDistance(std::vector<Ends> segments) : all_(std::make_shared<const All>(std::move(segments))) {}

SegmentDistance::SegmentDistance(const Pslg& pslg, std::span<const std::int32_t> markers)
    : SegmentDistance(segments_with(pslg, markers)) {}

SegmentDistance::SegmentDistance(std::shared_ptr<const All> all, std::vector<std::int32_t> few)
    : all_(std::move(all)), few_(std::move(few)) {}

SegmentDistance::Nearest SegmentDistance::nearest(const Point& p) const {
  if (few_.empty()) {
    // Not less than that of the box, so that no rounding error makes the least depend on the order of the search.
    const auto distance = [&](std::int32_t item) {
      const Ends& s = all_->segments[item];
      return std::max(squared_to(p, all_->lines[item]), Box::around(s.a, s.b).squared_distance(p));
    };
    const std::int32_t item = all_->tree.nearest(p, distance);
    return {&all_->lines[item], squared_to(p, all_->lines[item])};
  }
  Nearest best{&all_->lines[few_.front()], std::numeric_limits<double>::infinity()};
  for (const std::int32_t item : few_) {
    const Line& s = all_->lines[item];
    if (const double here = squared_to(p, s); here < best.squared_distance) best = {&s, here};
  }
  return best;
}

double SegmentDistance::at(const Point& p) const {
  return std::sqrt(nearest(p).squared_distance);
}

Variation SegmentDistance::over(const Box& box) const {
  constexpr Interval kAny{-1, 1};
  const double radius = half_diagonal(box);
  if (!std::isfinite(radius)) return {{0, intervals::kAll.high}, kAny, kAny, kAny};
  const Nearest rival = nearest(box.center());
  const double middle = std::sqrt(rival.squared_distance);
  const double rounding = 0x1p-48 * (middle + radius + all_->extent);  // for both distances
  const Interval value{std::max(middle - radius - rounding, 0.0), middle + radius + rounding};
  if (few_.empty()) return {value, kAny, kAny, kAny};
  DirectionRange slopes = slopes_of(*rival.line, box, radius);
  if (few_.size() > 1) {
    const NearestInSquare square = against(*rival.line, box);
    const double far = middle + 2 * radius + rounding;
    for (const std::int32_t item : few_) {
      const Line& s = all_->lines[item];
      if (&s == rival.line || squared_to(box.center(), s) > far * far || !may_be_nearest(square, s)) continue;
      slopes.extend(slopes_of(s, box, radius));
    }
  }
  return {value, {slopes.low_x, slopes.high_x}, {slopes.low_y, slopes.high_y}, kAny};
}

NearestInSquare SegmentDistance::against(const Line& rival, const Box& box) const {
  return NearestInSquare::against(
      box, [&](const Point& p) { return std::sqrt(squared_to(p, rival)); }, all_->margin);
}

/// The rival is the segment nearest to the center.
std::shared_ptr<const PlaneFunction> SegmentDistance::within(const Box& box) const {
  if (!few_.empty() && few_.size() <= kFewest) return nullptr;
  const NearestInSquare square = against(*nearest(box.center()).line, box);
  std::array<std::int32_t, kFew> found;
  std::size_t count = 0;  // more than kFew: too many
  const auto look_at = [&](std::int32_t item) {
    if (count > kFew || !may_be_nearest(square, all_->lines[item])) return;
    if (count < kFew) found[count] = item;
    ++count;
  };
  if (few_.empty()) {
    const auto enter = [&](const Box& around) { return count <= kFew && square.needs(0, around); };
    all_->tree.search(enter, look_at);
    if (count > kFew) return nullptr;
  } else {
    std::ranges::for_each(few_, look_at);
    if (count == few_.size()) return nullptr;
  }
  return std::shared_ptr<const SegmentDistance>(new SegmentDistance(all_, {found.begin(), found.begin() + count}));
}

}  // namespace driftmesh
