#pragma once

#include <functional>
#include <map>

#include "decompose/subdomain_mesh.hpp"
#include "migration/subdomain.hpp"

namespace driftmesh {

/// Calls a function with each subdomain that a rank holds, in ascending order, so that only one has to be unpacked at a
/// time. May be called repeatedly, with the same result each time.
using ShowSubdomain = std::function<void(SubdomainId, const SubdomainMesh&)>;
using HeldSubdomains = std::function<void(const ShowSubdomain&)>;

/// Shows one subdomain that has worked; a dormant one is woken meanwhile.
void show_subdomain(const Subdomain& subdomain, const ShowSubdomain& show);

/// The subdomains of a rank's loop after a run; `subdomains` must outlive the result. Dormant ones are woken one at a
/// time, only while they are visited.
[[nodiscard]] HeldSubdomains held_by_rank(const std::map<SubdomainId, Subdomain>& subdomains);

/// The points that refinement inserted on root `root` of a mesh, in order of position: calls visit(path, vertex) for
/// each.
void visit_splits(const Triangulation& mesh, RootId root, const std::function<void(dyadic::Path, VertexId)>& visit);

/// The subdomain whose rank numbers the points on a root: the left one if it exists.
[[nodiscard]] inline SubdomainId owner_of(const Decomposition::Root& root) {
  return root.left != kNoSubdomain ? root.left : root.right;
}

}  // namespace driftmesh
