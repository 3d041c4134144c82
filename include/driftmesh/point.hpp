#pragma once

namespace driftmesh {

/// A point of the plane. Coordinates of an input must be 0 or have magnitudes from 7.6e-37 to 1.7e72, where the
/// geometric predicates are exact.
struct Point {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

}  // namespace driftmesh
