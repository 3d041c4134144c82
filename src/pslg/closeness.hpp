#pragma once

#include <algorithm>
#include <cmath>

#include "driftmesh/point.hpp"

namespace driftmesh {

// When points count as equal. Coordinates computed in double precision (a point put on a segment, an end that was
// transformed twice) are off by a few units in the last place. No mesh can be represented inside such a gap, and none
// is intended. So distances below kCloseUlps units in the last place of the larger coordinate count as zero: in each
// axis between points, and from a point to a line.

inline constexpr double kCloseUlps = 4;

/// The distance that counts as zero at `p`; for a segment, the larger of those at its ends.
[[nodiscard]] inline double closeness(const Point& p) {
  return kCloseUlps * 0x1p-52 * std::max(std::fabs(p.x), std::fabs(p.y));
}
[[nodiscard]] inline double closeness(const Point& a, const Point& b) {
  return std::max(closeness(a), closeness(b));
}

enum class OnSegment { no, exactly, closely };

/// Whether `p`, which is not close to a or b, lies in the interior of the segment from a to b. A point that is close to
/// an end by the measure of the segment does not: otherwise each of two points could be on the other's segment.
[[nodiscard]] OnSegment on_segment(const Point& p, const Point& a, const Point& b);

/// Whether the interiors of the segments ab and cd cross in one point (exact).
[[nodiscard]] bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d);

/// The point where segments that cross properly meet, computed in quadruple precision and rounded once; inside the
/// bounding boxes of both.
[[nodiscard]] Point crossing_point(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace driftmesh
