#pragma once

#include <algorithm>
#include <cmath>

#include "sizing/medial_axis.hpp"

// Distances to an outline by its definition, segment by segment.

namespace driftmesh::testing {

inline Point nearest_on(const SegmentDistance::Ends& s, const Point& p) {
  const double ex = s.b.x - s.a.x, ey = s.b.y - s.a.y;
  const double t = std::clamp(((p.x - s.a.x) * ex + (p.y - s.a.y) * ey) / (ex * ex + ey * ey), 0.0, 1.0);
  return {s.a.x + t * ex, s.a.y + t * ey};
}

inline double gap(const Point& p, const Point& q) {
  return std::hypot(p.x - q.x, p.y - q.y);
}

inline double to_outline(const OutlineSegments& outline, const Point& p) {
  double least = HUGE_VAL;
  for (const SegmentDistance::Ends& s : outline) least = std::min(least, gap(p, nearest_on(s, p)));
  return least;
}

}  // namespace driftmesh::testing
