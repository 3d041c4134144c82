#pragma once

#include <span>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Moves each point that is within `distance` of one of `places` in both coordinates onto it: points of a file that had
/// other coordinates meanwhile. The places are farther apart than that.
void settle_points(std::vector<Point>& points, std::span<const Point> places, double distance);

}  // namespace driftmesh
