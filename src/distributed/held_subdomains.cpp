#include "distributed/held_subdomains.hpp"

namespace driftmesh {
namespace {

void visit_below(const Triangulation& mesh, SubsegmentId s, const std::function<void(dyadic::Path, VertexId)>& visit) {
  const Subsegment& node = mesh.subsegments[s];
  if (node.is_leaf()) return;
  visit_below(mesh, node.child, visit);
  visit(node.path, mesh.subsegments[node.child].vertex[1]);
  visit_below(mesh, node.second_child(), visit);
}

}  // namespace

void show_subdomain(const Subdomain& subdomain, const ShowSubdomain& show) {
  if (subdomain.dormant())
    show(subdomain.id(), subdomain.woken());
  else
    show(subdomain.id(), subdomain.mesh());
}

HeldSubdomains held_by_rank(const std::map<SubdomainId, Subdomain>& subdomains) {
  return [&subdomains](const ShowSubdomain& show) {
    for (const auto& [i, subdomain] : subdomains) show_subdomain(subdomain, show);
  };
}

void visit_splits(const Triangulation& mesh, RootId root, const std::function<void(dyadic::Path, VertexId)>& visit) {
  visit_below(mesh, mesh.roots[root].tree, visit);
}

}  // namespace driftmesh
