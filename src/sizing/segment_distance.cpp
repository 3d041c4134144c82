#include "sizing/segment_distance.hpp"

#include <algorithm>
#include <cmath>

#include "driftmesh/error.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

SegmentDistance::SegmentDistance(const Pslg& pslg, std::span<const std::int32_t> markers) {
  std::vector<Box> boxes;
  Box all;
  for (const Pslg::Segment& s : pslg.segments) {
    if (!markers.empty() && std::ranges::find(markers, s.marker) == markers.end()) continue;
    segments_.push_back({pslg.points[s.a], pslg.points[s.b]});
    boxes.push_back(Box::around(pslg.points[s.a], pslg.points[s.b]));
    all.extend(boxes.back());
  }
  if (segments_.empty()) throw Error("no segments to measure the distance to");
  tree_ = BoxTree(boxes);
  extent_ = std::sqrt(driftmesh::squared_distance(all.low, all.high));
}

/// Not less than that of the segment's box, so that no rounding error makes the answer depend on the order of a search.
double SegmentDistance::squared_distance(const Point& p, const Ends& segment) {
  return std::max(squared_distance_to_segment(p, segment.a, segment.b),
                  Box::around(segment.a, segment.b).squared_distance(p));
}

double SegmentDistance::at(const Point& p) const {
  const auto distance = [&](std::int32_t segment) { return squared_distance(p, segments_[segment]); };
  return std::sqrt(distance(tree_.nearest(p, distance)));
}

Interval SegmentDistance::over(const Box& box) const {
  const double radius = std::sqrt(driftmesh::squared_distance(box.low, box.high)) / 2;
  if (!std::isfinite(radius)) return {0, intervals::kAll.high};
  const double middle = at(box.center());
  const double rounding = 0x1p-48 * (middle + radius + extent_);  // of both distances
  return {std::max(middle - radius - rounding, 0.0), middle + radius + rounding};
}

}  // namespace driftmesh
