#pragma once

#include <algorithm>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// How far along the segment ab, 0 to 1, its point nearest to p lies. Rounded; a and b differ.
[[nodiscard]] inline double nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const double ex = b.x - a.x, ey = b.y - a.y;
  const double t = ((p.x - a.x) * ex + (p.y - a.y) * ey) / (ex * ex + ey * ey);
  return std::clamp(t, 0.0, 1.0);
}

/// Rounded; if an end is nearest, or the ends are one point, that is the end, whatever the segment.
[[nodiscard]] inline Point nearest_point_on_segment(const Point& p, const Point& a, const Point& b) {
  const double t = nearest_on_segment(p, a, b);
  return t < 1 ? Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)} : b;
}

/// To that point.
[[nodiscard]] inline double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point nearest = nearest_point_on_segment(p, a, b);
  const double dx = p.x - nearest.x, dy = p.y - nearest.y;
  return dx * dx + dy * dy;
}

}  // namespace driftmesh
