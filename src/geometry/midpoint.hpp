#pragma once

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The midpoint by the one formula that every rank uses: symmetric in its arguments, so both sides of an
/// interface compute the same bits whatever the direction in which they see the edge.
[[nodiscard]] inline Point midpoint(const Point& a, const Point& b) {
  return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

}  // namespace driftmesh
