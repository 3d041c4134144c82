#pragma once

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Sets the neighbors of all triangles and the half-edges of all leaf subsegments from the corners and ends alone, for
/// meshes that were stored without them. Every slot must hold a triangle. Linear time.
/// Throws Error if an edge has more than two triangles, two on the same side, only one but no subsegment, or if a
/// subsegment is not the edge of a triangle.
void link_triangles(Triangulation& mesh);

}  // namespace driftmesh
