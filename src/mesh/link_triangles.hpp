#pragma once

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Sets the neighbors of all triangles, and the half-edges of all leaf subsegments, from corners and ends alone: in
/// linear time, for meshes that were stored without them. Every slot holds a triangle.
/// Throws Error if an edge has more than two triangles, or two on one side, or none where a subsegment lies; or if it
/// has one and no subsegment.
void link_triangles(Triangulation& mesh);

}  // namespace driftmesh
