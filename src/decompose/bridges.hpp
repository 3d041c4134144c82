#pragma once

#include "decompose/planar_map.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The walls of a triangulated domain, and bridges: extra walls that connect holes, islands of inner segments and
/// isolated points to the rest, so that every piece of the domain has one loop as its border. Bridges are short edges
/// of a constrained Delaunay triangulation of the refined border (part of a minimum spanning tree), as perpendicular to
/// walls as possible: they make an angle of at least `angle` (radians) with everything they meet, where such an edge
/// exists. `spacing`: distance between the points of straight segments at which a bridge may end. Shell pieces (see
/// mesh/corners.hpp) stay whole. Segments must still be whole, without split points of refinement.
[[nodiscard]] PlanarMap connected_walls(const Triangulation& mesh, double spacing, double angle);

}  // namespace driftmesh
