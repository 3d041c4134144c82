#include "job/facts_book.hpp"

#include "distributed/census.hpp"
#include "distributed/held_subdomains.hpp"

namespace driftmesh::job {
namespace {

/// Subsegments of the input on roots whose points this subdomain numbers.
std::int64_t owned_subsegments(const Decomposition& d, const SubdomainCensus& census) {
  std::int64_t count = 0;
  for (const SubdomainCensus::Root& r : census.roots) {
    const Decomposition::Root& root = d.roots[r.root];
    if (!root.separator && owner_of(root) == census.id) count += static_cast<std::int64_t>(r.splits.count) + 1;
  }
  return count;
}

}  // namespace

void FactsBook::note(const Subdomain& subdomain, const QualityBounds& bounds) {
  auto facts = std::make_unique<MeshFacts>();
  show_subdomain(subdomain, [&](SubdomainId id, const SubdomainMesh& part) {
    add_part(*facts, part.mesh, bounds, true);
    const SubdomainCensus census = census_of(decomposition_, id, part);
    facts->vertices = owned_points(decomposition_, census);
    facts->subsegments = owned_subsegments(decomposition_, census);
  });
  add_counters(*facts, subdomain.counters());
  facts_[subdomain.id()] = std::move(facts);
}

}  // namespace driftmesh::job
