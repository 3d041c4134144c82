#pragma once

#include <cstdint>
#include <vector>

#include "distributed/held_subdomains.hpp"
#include "protocol/split_set.hpp"

namespace driftmesh {

/// How many vertices a subdomain has of each kind, and which.
struct SubdomainCensus {
  struct Root {
    GlobalRootId root{};
    protocol::SplitDigest splits;  ///< of the points on it
  };
  SubdomainId id{};
  std::int64_t free_points = 0;  ///< on no root
  std::int64_t triangles = 0;
  std::vector<Root> roots;  ///< ascending
};

/// Of each subdomain shown, ascending. Throws Error if they are not shown in ascending order, or are not of the
/// decomposition.
[[nodiscard]] std::vector<SubdomainCensus> take_census(const Decomposition& decomposition, const HeldSubdomains& held);

/// The numbers of points on roots that subdomain `census.id` owns, and of those inside it.
[[nodiscard]] std::int64_t owned_points(const Decomposition& decomposition, const SubdomainCensus& census);

}  // namespace driftmesh
