#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "migration/subdomain.hpp"
#include "sim/domains.hpp"

namespace driftmesh::sim {

/// The subdomains as one mesh, joined by coordinates alone: points are the same if they are equal to the last bit.
[[nodiscard]] Mesh merge(const Domain& domain, const Decomposition& decomposition,
                         const std::vector<const Subdomain*>& subdomains);

/// Verifies the merged mesh against the domain's input and bounds: every piece is constrained Delaunay by the exact
/// predicate, bounds are met except for accepted exceptions, areas add up, input segments are covered. Returns the
/// problem, or "".
[[nodiscard]] std::string verdict_on_mesh(const Domain& domain, const Decomposition& decomposition,
                                          const std::vector<const Subdomain*>& subdomains);

}  // namespace driftmesh::sim
