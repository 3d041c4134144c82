#pragma once

#include <cstdint>

#include "mesh/area_bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Deletes free vertices of a refined mesh at triangles that do not allow the time step, wherever fewer of them are
/// left around the vertex, all new triangles meet the angle bound (degrees), and they are no larger than the bounds on
/// sizes and the step together allow (SizeBounds::spares_thinned). Points on segments stay. Returns the number of
/// vertices. Nothing is done without a time step. What is deleted depends on the triangles alone, not on their slots or
/// first corners. The mesh stays constrained Delaunay.
std::int64_t thin_for_step(Triangulation& mesh, double min_angle, const AreaBounds& areas);

}  // namespace driftmesh
