#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/mesh_edges.hpp"
#include "support/made_mesh.hpp"

namespace driftmesh::testing {

/// The size of a mesh that was made in subdomains.
struct CutMeshSize {
  std::size_t triangles = 0;
  std::size_t separator_edges = 0;  ///< edges of the mesh that lie on separators
  Decomposition decomposition;
  bool complete = true;  ///< false: there were more triangles than allowed, and nothing else is known
};

/// Makes the mesh that the request asks for in this many subdomains.
[[nodiscard]] inline CutMeshSize cut_mesh_size(const Pslg& input, job::Request request, std::int32_t subdomains,
                                               std::int64_t most_triangles) {
  request.decomposition.subdomains = subdomains;
  request.limits = {.max_triangles = most_triangles};
  try {
    Made cut = made(input, request);
    const TriangleNeighbors neighbors = triangle_neighbors(cut.mesh);
    const auto separators = separator_edges(cut.mesh, neighbors, ConstrainedEdgeIndex(cut.mesh), 0);
    return {cut.mesh.triangles.size(), separators.size(), std::move(cut.decomposition)};
  } catch (const LimitError&) {
    CutMeshSize size;
    size.complete = false;
    return size;
  }
}

}  // namespace driftmesh::testing
