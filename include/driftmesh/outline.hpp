#pragma once

#include <string>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The domain that a mesh covers, to be meshed anew: the edges on its boundary become segments, as do the constrained
/// edges inside and those between different regions, all with their markers (0 if the mesh has none for them). Their
/// ends keep their markers; the points inside and all attributes stay behind. There is a seed in each hole, and one
/// with the label in each area of a region, unless that is 0.
///
/// Throws InputError, naming `file`, for a mesh without triangles, and for one whose boundary does not enclose the area
/// of its triangles: they overlap, or two parts of the boundary lie on one another.
///
/// \code
/// const driftmesh::Mesh coarse = driftmesh::mesh(driftmesh::generate("pipe"));
/// const driftmesh::Mesh fine = driftmesh::mesh(driftmesh::outline(coarse), {.max_area = 50});
/// assert(fine.triangles.size() > coarse.triangles.size());
/// \endcode
[[nodiscard]] Pslg outline(const Mesh& mesh, const std::string& file = "mesh");

}  // namespace driftmesh
