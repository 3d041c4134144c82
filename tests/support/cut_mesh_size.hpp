#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "decompose/decompose.hpp"
#include "support/refine_together.hpp"

namespace driftmesh::testing {

/// The size of a mesh that was made in subdomains.
struct CutMeshSize {
  std::size_t triangles = 0;
  std::size_t separator_edges = 0;  ///< edges of the mesh that lie on separators
  bool complete = true;             ///< false: a subdomain was about to have more triangles than allowed
};

/// Refines the subdomains together, their interfaces split to size beforehand, as runs do.
inline CutMeshSize cut_mesh_size(const Decomposition& d, const QualityBounds& bounds, std::int64_t most_triangles) {
  RefineTogether how;
  how.presplit = true;
  how.most_triangles = most_triangles;
  const RefinedTogether refined = refine_together(d, bounds, how);
  CutMeshSize size;
  size.complete = refined.complete;
  std::map<GlobalRootId, std::size_t> edges;
  for (const SubdomainMesh& part : refined.parts) {
    size.triangles += part.mesh.live_triangles();
    std::map<GlobalRootId, std::size_t> of_part;
    for (const Subsegment& s : part.mesh.subsegments)
      if (s.is_leaf() && d.roots[part.roots[s.root]].separator) ++of_part[part.roots[s.root]];
    for (const auto& [root, count] : of_part) edges[root] = count;
  }
  for (const auto& [root, count] : edges) size.separator_edges += count;
  return size;
}

}  // namespace driftmesh::testing
