#pragma once

#include <map>
#include <vector>

#include "decompose/subdomain_mesh.hpp"

namespace driftmesh::testing {

/// The split points of each root by path, with coordinates.
using SplitPoints = std::map<GlobalRootId, std::map<dyadic::Path, Point>>;

inline SplitPoints split_points(const SubdomainMesh& part) {
  SplitPoints points;
  for (const Subsegment& s : part.mesh.subsegments)
    if (!s.is_leaf()) {
      const VertexId middle = part.mesh.subsegments[s.child].vertex[1];
      points[part.roots[s.root]][s.path] = part.mesh.points[middle];
    }
  return points;
}

/// The roots of this part whose split points differ from those that an earlier part had there. `first` has the points
/// of the earlier parts, and gets those of this one.
inline std::vector<GlobalRootId> not_conforming_roots(const SubdomainMesh& part, SplitPoints& first) {
  std::vector<GlobalRootId> differing;
  SplitPoints own = split_points(part);
  for (const GlobalRootId r : part.roots) {
    const auto [entry, is_new] = first.emplace(r, own[r]);
    if (!is_new && entry->second != own[r]) differing.push_back(r);
  }
  return differing;
}

}  // namespace driftmesh::testing
