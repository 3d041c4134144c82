#pragma once

#include "decompose/planar_map.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The walls of a triangulated domain, and bridges: extra walls that connect holes, islands of inner segments and
/// isolated points with the rest, so that every piece of the domain has one loop as its border. Bridges are short edges
/// of a constrained Delaunay triangulation of the refined border (a part of a minimum spanning tree), perpendicular to
/// walls as far as possible: at least `angle` (radians) with everything where such an edge exists.
/// `spacing`: distance between the points of straight segments at which a bridge may end. Shell pieces (see
/// mesh/corners.hpp) stay whole. Segments must be whole: no split point of refinement yet.
[[nodiscard]] PlanarMap connected_walls(const Triangulation& mesh, double spacing, double angle);

}  // namespace driftmesh
