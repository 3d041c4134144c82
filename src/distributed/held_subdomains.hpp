#pragma once

#include <functional>
#include <map>
#include <vector>

#include "decompose/subdomain_mesh.hpp"
#include "migration/subdomain.hpp"

namespace driftmesh {

/// Shows the subdomains that a rank holds to a function, one at a time and in ascending order, so that no more than
/// one has to be unpacked. It is called more than once and shows the same each time.
using ShowSubdomain = std::function<void(SubdomainId, const SubdomainMesh&)>;
using HeldSubdomains = std::function<void(const ShowSubdomain&)>;

struct HeldSubdomain {
  SubdomainId id{};
  const SubdomainMesh* mesh = nullptr;  ///< not owned
};
/// Subdomains that lie in memory, given in any order.
[[nodiscard]] HeldSubdomains held_in_memory(std::vector<HeldSubdomain> held);

/// The subdomains of a rank's loop when a run has ended; `subdomains` outlives the result. Those that sleep are woken
/// one at a time, for as long as they are shown.
[[nodiscard]] HeldSubdomains held_by_rank(const std::map<SubdomainId, Subdomain>& subdomains);

/// The points that refinement put on root `root` of a mesh, in the order of their positions on it: calls
/// visit(path, vertex) for each.
void visit_splits(const Triangulation& mesh, RootId root, const std::function<void(dyadic::Path, VertexId)>& visit);

/// The subdomain whose rank numbers the points on a root: the left one if there is one.
[[nodiscard]] inline SubdomainId owner_of(const Decomposition::Root& root) {
  return root.left != kNoSubdomain ? root.left : root.right;
}

}  // namespace driftmesh
