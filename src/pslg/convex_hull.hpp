#pragma once

#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The border of the convex hull of distinct points as segments with marker 1, through every point that lies on it.
/// Exact (Andrew's monotone chain). Empty if all points are collinear.
[[nodiscard]] std::vector<Pslg::Segment> convex_hull(const std::vector<Point>& points);

}  // namespace driftmesh
