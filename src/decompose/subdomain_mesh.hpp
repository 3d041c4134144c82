#pragma once

#include <vector>

#include "decompose/decomposition.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The initial triangulation of one subdomain.
struct SubdomainMesh {
  /// Root i of the mesh is root roots[i] of the decomposition, with the same direction and shell; vertex v is its point
  /// points[v]. The origin of a vertex is that GlobalPointId, or the shell end that the decomposition names. Regions
  /// are labeled as in the whole domain.
  Triangulation mesh;
  IdVector<RootId, GlobalRootId> roots;
  IdVector<VertexId, GlobalPointId> points;
};

/// The constrained Delaunay triangulation of subdomain `i`. Throws Error if the decomposition is broken there.
[[nodiscard]] SubdomainMesh subdomain_triangulation(const Decomposition& decomposition, SubdomainId i);

}  // namespace driftmesh
