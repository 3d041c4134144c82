#pragma once

#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The cells of a mesh that are ghosts.
struct GhostCells {
  std::vector<bool> triangles, edges;
};

/// Leaves out triangles that are ghosts, edges that are and have no other triangle, and points that only those use.
void drop_ghosts(Mesh& mesh, const GhostCells& ghosts);

}  // namespace driftmesh
