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

/// The points of subdomain `i`, on its roots and inside, in ascending order.
[[nodiscard]] IdVector<VertexId, GlobalPointId> points_of(const Decomposition& decomposition, SubdomainId i);
/// The origin of a vertex that is point `v`.
[[nodiscard]] VertexOrigin origin_of(const Decomposition& decomposition, GlobalPointId v);

/// The constrained Delaunay triangulation of subdomain `i`. Throws Error if the decomposition is broken there.
[[nodiscard]] SubdomainMesh subdomain_triangulation(const Decomposition& decomposition, SubdomainId i);

}  // namespace driftmesh
