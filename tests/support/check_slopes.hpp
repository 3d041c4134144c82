#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "sizing/plane_function.hpp"

namespace driftmesh::testing {

/// Requires that a function changes between two points of a box, along either axis and straight, by no more than what
/// is known of it over the box allows, up to rounding.
inline void check_slopes(const PlaneFunction& function, const Variation& over_box, const Point& p, const Point& q,
                         double rounding) {
  const auto check = [&](const Point& to, const Interval& slopes, double by) {
    const double rise = function.at(to) - function.at(p), a = slopes.low * by, b = slopes.high * by;
    if (by == 0)
      REQUIRE(rise == 0);
    else
      REQUIRE((rise >= std::min(a, b) - rounding && rise <= std::max(a, b) + rounding));
  };
  check({q.x, p.y}, over_box.in_x, q.x - p.x);
  check({p.x, q.y}, over_box.in_y, q.y - p.y);
  const double way = std::hypot(q.x - p.x, q.y - p.y), steepest = over_box.steepest();
  check(q, over_box.in_directions, way);
  check(q, {-steepest, steepest}, way);
}

}  // namespace driftmesh::testing
