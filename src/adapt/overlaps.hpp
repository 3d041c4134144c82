#pragma once

#include <array>
#include <functional>
#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// The part that a new triangle of a subdomain has in common with an old one: a convex polygon.
struct Overlap {
  TriangleId old_triangle{};
  TriangleId new_triangle{};
  std::vector<Point> corners;  ///< counterclockwise
  double area = 0;
};

/// All overlaps of new triangles that `is_new` names with old ones, new triangle by new triangle. Both meshes cover the
/// same polygon. Overlaps are rounded: those of an old triangle sum up to its area but for some 1e-15 of its size.
[[nodiscard]] std::vector<Overlap> overlaps_of(const Triangulation& old_mesh, const Triangulation& new_mesh,
                                               const std::function<bool(TriangleId)>& is_new);

}  // namespace driftmesh::adapt
