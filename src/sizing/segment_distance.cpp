#include "sizing/segment_distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

std::vector<NearestCells::Ends> segments_with(const Pslg& pslg, std::span<const std::int32_t> markers) {
  std::vector<NearestCells::Ends> segments;
  for (const Pslg::Segment& s : pslg.segments) {
    if (!markers.empty() && std::ranges::find(markers, s.marker) == markers.end()) continue;
    segments.push_back({pslg.points[s.a], pslg.points[s.b]});
  }
  if (segments.empty()) throw Error("no segments to measure the distance to");
  return segments;
}

}  // namespace

SegmentDistance::SegmentDistance(const Pslg& pslg, std::span<const std::int32_t> markers)
    : segments_(segments_with(pslg, markers)),
      extent_(std::sqrt(squared_distance(segments_.box().low, segments_.box().high))) {}

double SegmentDistance::at(const Point& p) const {
  return std::sqrt(segments_.squared_distance(p));
}

Interval SegmentDistance::over(const Box& box) const {
  const double radius = std::sqrt(squared_distance(box.low, box.high)) / 2;
  if (!std::isfinite(radius)) return {0, intervals::kAll.high};
  const double middle = at(box.center());
  const double rounding = 0x1p-48 * (middle + radius + extent_);  // for both distances
  return {std::max(middle - radius - rounding, 0.0), middle + radius + rounding};
}

}  // namespace driftmesh
