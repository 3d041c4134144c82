#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/box.hpp"

namespace driftmesh {

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

 private:
  Point center_, half_;
  double slope_;
  std::array<double, 4> rival_;
};

/// The range of the unit vectors from a convex set to the points of a disk of this radius, whose center is farther from
/// the set than that and in this direction: with the center, the vector from the nearest point of the set moves no
/// farther than the center does (it is nonexpansive).
struct DirectionRange {
  double low_x, high_x, low_y, high_y;
};
[[nodiscard]] inline DirectionRange directions_around(const Point& direction, double radius, double distance) {
  constexpr double kRoot = 1.41421356237309515;  // of a chord to the sine of its angle, at most, up to a right angle
  if (!(radius < distance)) return {-1, 1, -1, 1};
  const double change = kRoot * radius / distance + 0x1p-40;
  return {std::max(direction.x - change, -1.0), std::min(direction.x + change, 1.0),
          std::max(direction.y - change, -1.0), std::min(direction.y + change, 1.0)};
}

}  // namespace driftmesh
