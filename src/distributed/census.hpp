#pragma once

#include <cstdint>
#include <vector>

#include "distributed/held_subdomains.hpp"
#include "protocol/split_set.hpp"

namespace driftmesh {

/// The numbers of vertices of each kind in a subdomain, and the points on its roots.
struct SubdomainCensus {
  struct Root {
    GlobalRootId root{};
    protocol::SplitDigest splits;  ///< digest of the points on it
  };
  SubdomainId id{};
  std::int64_t free_points = 0;  ///< points on no root
  std::int64_t triangles = 0;
  std::vector<Root> roots;  ///< ascending
};

/// The census of one subdomain. Throws Error if it does not belong to the decomposition.
[[nodiscard]] SubdomainCensus census_of(const Decomposition& decomposition, SubdomainId i, const SubdomainMesh& part);

/// The census of each subdomain visited. Throws Error if they are not visited in ascending order, or do not belong to
/// the decomposition.
[[nodiscard]] std::vector<SubdomainCensus> take_census(const Decomposition& decomposition, const HeldSubdomains& held);

/// The number of points on roots that subdomain `census.id` owns, plus the number of those inside it.
[[nodiscard]] std::int64_t owned_points(const Decomposition& decomposition, const SubdomainCensus& census);

}  // namespace driftmesh
