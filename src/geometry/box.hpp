#pragma once

#include <algorithm>
#include <limits>

#include "driftmesh/point.hpp"
#include "geometry/midpoint.hpp"

namespace driftmesh {

/// A closed axis-parallel box, empty until extended.
struct Box {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  /// The smallest box that holds all points within `margin` of the segment ab in each axis.
  [[nodiscard]] static Box around(const Point& a, const Point& b, double margin = 0) {
    return {{std::min(a.x, b.x) - margin, std::min(a.y, b.y) - margin},
            {std::max(a.x, b.x) + margin, std::max(a.y, b.y) + margin}};
  }

  /// The smallest box that holds all of `points`, a range of Point.
  template <class Points>
  [[nodiscard]] static Box of(const Points& points) {
    Box box;
    for (const Point& p : points) box.extend(p);
    return box;
  }

  void extend(const Point& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void extend(const Box& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y)};
  }
  [[nodiscard]] bool contains(const Point& p) const {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
  }
  /// Whether they share a point.
  [[nodiscard]] bool overlaps(const Box& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y;
  }
  [[nodiscard]] Point center() const { return midpoint(low, high); }
  /// 0 inside.
  [[nodiscard]] double squared_distance(const Point& p) const {
    const double dx = std::max({low.x - p.x, p.x - high.x, 0.0});
    const double dy = std::max({low.y - p.y, p.y - high.y, 0.0});
    return dx * dx + dy * dy;
  }
};

}  // namespace driftmesh
