#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

/// How far the points of a box are from its center.
[[nodiscard]] inline double half_diagonal(const Box& box) {
  return std::sqrt(squared_distance(box.low, box.high)) / 2;
}

/// More than what rounding does to distances between points of a box: ten times.
[[nodiscard]] inline double margin_in(const Box& box) {
  const double farthest =
      std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
  return 0x1p-43 * (farthest + 2 * half_diagonal(box));
}

/// Finds out what may be the least of some functions somewhere in a square. Each is a weight and a slope times the
/// distance to a convex set. What exceeds a rival, another convex function, at all points of the square is not needed.
class NearestInSquare {
 public:
  /// The corners of a box, in the order of the rival's values below.
  [[nodiscard]] static std::array<Point, 4> corners_of(const Box& box) {
    return {box.low, {box.high.x, box.low.y}, {box.low.x, box.high.y}, box.high};
  }

  /// `rival`: its values at the corners, or more.
  NearestInSquare(const Box& square, double slope, const std::array<double, 4>& rival)
      : center_(square.center()),
        half_{(square.high.x - square.low.x) / 2, (square.high.y - square.low.y) / 2},
        slope_(slope),
        rival_(rival) {}

  /// Against one of the functions with slope 1, from its values, and a margin for their rounding.
  template <class Function>
  [[nodiscard]] static NearestInSquare against(const Box& square, const Function& rival, double margin) {
    std::array<double, 4> at_corners;
    const std::array<Point, 4> corners = corners_of(square);
    for (std::size_t k = 0; k < 4; ++k) at_corners[k] = rival(corners[k]) + margin;
    return {square, 1, at_corners};
  }

  [[nodiscard]] const Point& center() const { return center_; }

  /// Whether the function of a set with this weight may be less than the rival. `nearest`: the point of the set that is
  /// nearest to the center. `along(direction)`: at most how far the center is from any point of the set in a direction.
  ///
  /// The distance to a convex set is at least that in any one direction, a linear function, here in the direction of
  /// the center; the rival is convex, so it exceeds that function at a corner if anywhere.
  template <class Along>
  [[nodiscard]] bool needs(double weight, const Point& nearest, Along&& along) const {
    const double dx = center_.x - nearest.x, dy = center_.y - nearest.y;
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (!(distance > 0)) return weight < *std::max_element(rival_.begin(), rival_.end());
    const Point direction{dx / distance, dy / distance};
    const double at_center = weight + slope_ * along(direction);
    const double x = slope_ * half_.x * direction.x, y = slope_ * half_.y * direction.y;
    return rival_[0] >= at_center - x - y || rival_[1] >= at_center + x - y || rival_[2] >= at_center - x + y ||
           rival_[3] >= at_center + x + y;
  }

  /// The same for a box.
  [[nodiscard]] bool needs(double weight, const Box& box) const {
    const Point nearest{std::clamp(center_.x, box.low.x, box.high.x), std::clamp(center_.y, box.low.y, box.high.y)};
    return needs(weight, nearest,
                 [&](const Point& d) { return d.x * (center_.x - nearest.x) + d.y * (center_.y - nearest.y); });
  }

  /// The same for the segment ab, without a weight.
  [[nodiscard]] bool needs(const Point& nearest, const Point& a, const Point& b) const {
    return needs(0, nearest, [&](const Point& d) {
      const auto along = [&](const Point& p) { return d.x * (center_.x - p.x) + d.y * (center_.y - p.y); };
      return std::min(along(a), along(b));
    });
  }

 private:
  Point center_, half_;
  double slope_;
  std::array<double, 4> rival_;
};

/// The range of the unit vectors from a convex set to the points of a disk of this radius, whose center is farther from
/// the set than that and in this direction: with the center, the vector from the nearest point of the set moves no
/// farther than the center does (it is nonexpansive).
struct DirectionRange {
  double low_x = 1, high_x = -1, low_y = 1, high_y = -1;  // none

  void extend(const DirectionRange& by) {
    *this = {std::min(low_x, by.low_x), std::max(high_x, by.high_x), std::min(low_y, by.low_y),
             std::max(high_y, by.high_y)};
  }
};
[[nodiscard]] inline DirectionRange directions_around(const Point& direction, double radius, double distance) {
  constexpr double kRoot = 1.41421356237309515;  // at most: a chord over the sine of its angle, up to a right one
  if (!(radius < distance)) return {-1, 1, -1, 1};
  const double change = kRoot * radius / distance + 0x1p-40;
  return {std::max(direction.x - change, -1.0), std::min(direction.x + change, 1.0),
          std::max(direction.y - change, -1.0), std::min(direction.y + change, 1.0)};
}

}  // namespace driftmesh
