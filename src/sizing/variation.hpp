#pragma once

#include <algorithm>
#include <cmath>

#include "sizing/interval.hpp"

namespace driftmesh {

/// What is known of a function over a box: its values, and its slopes, the differences of its values at two points of
/// the box divided by their distance. kAll where a slope is unknown, as at jumps.
struct Variation {
  Interval value;
  Interval in_x, in_y;     ///< slopes along lines parallel to the axes
  Interval in_directions;  ///< slopes along lines in any direction; holds 0 and is symmetric

  /// A bound on all slopes.
  [[nodiscard]] double steepest() const {
    const auto most = [](const Interval& a) { return std::max(std::fabs(a.low), std::fabs(a.high)); };
    return std::min(most(in_directions), std::hypot(most(in_x), most(in_y)));
  }
};

}  // namespace driftmesh
