#pragma once

#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Segments that form closed rings inside the domain.
struct NestedRings {
  /// A vertex of each group of connected rings, apart from all others, inside which there is neither a hole nor a
  /// region point.
  std::vector<VertexId> unexplained;
  /// A point in each area that an even number of rings encloses, the outer boundary included, except for areas with a
  /// region: the holes, if rings alternate between holes and islands. Rings that touch at points are told apart. Where
  /// rings share segments, so that it is not known which they are, they count as one ring around all that they enclose.
  std::vector<Point> alternating_holes;
};

/// `carved` must be what triangulate() returns: not refined, regions labeled.
[[nodiscard]] NestedRings find_nested_rings(const Triangulation& carved);

}  // namespace driftmesh
