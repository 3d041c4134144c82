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
  auto page = std::make_unique<Page>();
  show_subdomain(subdomain, [&](SubdomainId id, const SubdomainMesh& part) {
    add_part(page->facts, part.mesh, bounds, true);
    page->census = driftmesh::census_of(decomposition_, id, part);
    page->facts.vertices = owned_points(decomposition_, page->census);
    page->facts.subsegments = owned_subsegments(decomposition_, page->census);
  });
  add_counters(page->facts, subdomain.counters());
  pages_[subdomain.id()] = std::move(page);
}

}  // namespace driftmesh::job
