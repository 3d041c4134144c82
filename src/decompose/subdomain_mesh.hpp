#pragma once

#include <vector>

#include "decompose/decomposition.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The initial triangulation of one subdomain.
struct SubdomainMesh {
  /// Root i of the mesh is root `roots[i]` of the decomposition, with the same direction and shell. The origin of a
  /// vertex is its GlobalPointId, or its shell end as in the decomposition. Regions are labelled as in the whole
  /// domain.
  Triangulation mesh;
  std::vector<RootId> roots;
};

/// The constrained Delaunay triangulation of subdomain `i`. Throws Error if the decomposition is broken there.
[[nodiscard]] SubdomainMesh subdomain_triangulation(const Decomposition& decomposition, SubdomainId i);

}  // namespace driftmesh
