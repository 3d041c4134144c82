#pragma once

namespace driftmesh {

/// A point of the plane. Coordinates that enter the mesher are finite and lie in the range that
/// predicates.hpp states.
struct Point {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

/// The midpoint by the one formula that every rank uses: symmetric in its arguments, so both sides of an interface
/// compute the same bits although they see the edge in opposite directions.
[[nodiscard]] inline Point midpoint(const Point& a, const Point& b) {
  return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

}  // namespace driftmesh
