#pragma once

namespace driftmesh {

/// A point of the plane. A coordinate that is meshed must be 0 or of a size from 7.5e-37 to 1.8e72.
struct Point {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

}  // namespace driftmesh
