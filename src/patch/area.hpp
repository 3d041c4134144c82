#pragma once

#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "geometry/box.hpp"

namespace driftmesh::patch {

/// The triangles that share more than their border with an area, one entry for each triangle of the mesh.
[[nodiscard]] std::vector<bool> triangles_in(const Mesh& mesh, const Box& box);
/// The same for the interior of polygons. Without polygons, segments bound areas: inside is what an odd number of them
/// is around.
[[nodiscard]] std::vector<bool> triangles_in(const Mesh& mesh, const Pslg& polygons);
/// The triangles of a region.
[[nodiscard]] std::vector<bool> triangles_of_region(const Mesh& mesh, double attribute);

}  // namespace driftmesh::patch
