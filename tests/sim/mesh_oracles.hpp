#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "migration/subdomain.hpp"
#include "sim/domains.hpp"

namespace driftmesh::sim {

/// The subdomains as one mesh, put together from coordinates alone: points are the same where they are equal to the
/// last bit.
[[nodiscard]] Mesh merge(const Domain& domain, const Decomposition& decomposition,
                         const std::vector<const Subdomain*>& subdomains);

/// What the independent judge says to the merged mesh against the domain's input and bounds: every piece constrained
/// Delaunay by the exact predicate, bounds met but for the exceptions that the input explains, areas summed, input
/// segments covered. Empty if it accepts.
[[nodiscard]] std::string judge(const Domain& domain, const Decomposition& decomposition,
                                const std::vector<const Subdomain*>& subdomains);

}  // namespace driftmesh::sim
