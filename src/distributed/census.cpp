#include "distributed/census.hpp"

#include <algorithm>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

SubdomainCensus census_of(const Decomposition& decomposition, SubdomainId i, const SubdomainMesh& part) {
  if (!decomposition.subdomains.has(i)) throw Error("subdomain " + to_string(i) + " is not in the decomposition");
  const auto roots = decomposition.roots_of(i);
  if (!std::equal(roots.begin(), roots.end(), part.roots.begin(), part.roots.end()))
    throw Error("subdomain " + to_string(i) + " does not have the roots that the decomposition gives it");
  SubdomainCensus census;
  census.id = i;
  census.triangles = static_cast<std::int64_t>(part.mesh.live_triangles());
  census.free_points = std::count(part.mesh.origin.begin(), part.mesh.origin.end(), kFree);
  for (const RootId r : ids_of(part.roots)) {
    SubdomainCensus::Root root{part.roots[r], {}};
    visit_splits(part.mesh, r, [&](dyadic::Path path, VertexId) { root.splits.add(path); });
    census.roots.push_back(root);
  }
  return census;
}

std::vector<SubdomainCensus> take_census(const Decomposition& decomposition, const HeldSubdomains& held) {
  std::vector<SubdomainCensus> all;
  held([&](SubdomainId i, const SubdomainMesh& part) {
    if (!all.empty() && i <= all.back().id) throw Error("subdomain " + to_string(i) + " is visited out of order");
    all.push_back(census_of(decomposition, i, part));
  });
  return all;
}

std::int64_t owned_points(const Decomposition& decomposition, const SubdomainCensus& census) {
  std::int64_t count = census.free_points;
  for (const SubdomainCensus::Root& r : census.roots)
    if (owner_of(decomposition.roots[r.root]) == census.id) count += static_cast<std::int64_t>(r.splits.count);
  return count;
}

}  // namespace driftmesh
