#pragma once

#include <memory>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// A size field with a length for each point of a mesh, linear on its triangles; outside of it, the length at the
/// nearest point of its boundary. For adaptive refinement: `mesh` is the last one, `lengths` are what its solution asks
/// for. Lengths are > 0, or infinite for no bound. `gradation`: by how much they may grow per unit of distance along
/// the edges of the mesh, which lowers some of them; 0: no limit, 0.2 to 0.3 grade well.
///
/// May be asked by several threads at once. Pass it as MeshOptions::size by std::ref. Throws Error unless there is a
/// positive length for each point, and for a mesh without triangles.
///
/// \code
/// const driftmesh::Pslg pipe = driftmesh::generate("pipe");
/// const driftmesh::Mesh last = driftmesh::mesh(pipe);
/// std::vector<double> lengths(last.points.size(), 40);
/// lengths[0] = 2;  // where the solution on it asks for more
/// const auto sizes = driftmesh::size_on_mesh(last, lengths, 0.3);
/// const driftmesh::Mesh next = driftmesh::mesh(pipe, {.size = std::ref(*sizes)});
/// \endcode
[[nodiscard]] std::shared_ptr<const SizeField> size_on_mesh(const Mesh& mesh, std::vector<double> lengths,
                                                            double gradation = 0);

}  // namespace driftmesh
