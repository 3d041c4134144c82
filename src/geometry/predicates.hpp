#pragma once

#include "geometry/point.hpp"

#ifdef __FAST_MATH__
#error "exact predicates need IEEE arithmetic: do not compile with -ffast-math"
#endif

namespace driftmesh {

/// The sign of the answer is exact: evaluated with expansions (Shewchuk 1997), no filter. Out of line, cold.
[[nodiscard]] double orient2d_exact(const Point& a, const Point& b, const Point& c);
[[nodiscard]] double incircle_exact(const Point& a, const Point& b, const Point& c, const Point& d);

/// > 0 if a, b, c make a left turn, < 0 for a right turn, 0 exactly when they are collinear.
[[nodiscard]] inline double orient2d(const Point& a, const Point& b, const Point& c) {
  return orient2d_exact(a, b, c);
}

/// > 0 if d lies strictly inside the circle through a, b, c (counterclockwise), < 0 outside, 0 exactly when cocircular.
[[nodiscard]] inline double incircle(const Point& a, const Point& b, const Point& c, const Point& d) {
  return incircle_exact(a, b, c, d);
}

}  // namespace driftmesh
