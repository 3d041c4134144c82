#pragma once

#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Segments that form closed rings inside the domain, apart from all others.
struct NestedRings {
  /// A vertex of each group of connected rings inside which there is neither a hole nor a region point.
  std::vector<VertexId> unexplained;
  /// A point in each area that an odd number of groups separates from the outer boundary, except for areas with a
  /// region point: the holes, if rings alternate between holes and islands.
  std::vector<Point> alternating_holes;
};

/// `carved` must be what triangulate() returns: not refined, regions labeled.
[[nodiscard]] NestedRings find_nested_rings(const Triangulation& carved);

}  // namespace driftmesh
