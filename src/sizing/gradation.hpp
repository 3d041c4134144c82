#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Lowers `lengths`, one for each point, until none grows along an edge of the triangles by more than `gradation` times
/// the length of the edge: lengths[i] becomes the minimum over j of lengths[j] + gradation * (shortest path along
/// edges from i to j). This is the largest function below the given one that respects the limit on every edge. Infinite
/// lengths are allowed. gradation >= 0; 0 makes each connected component uniform.
void limit_gradation(const std::vector<Point>& points, const std::vector<std::array<std::int32_t, 3>>& triangles,
                     double gradation, std::vector<double>& lengths);

}  // namespace driftmesh
