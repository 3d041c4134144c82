#pragma once

#include <cstdint>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/ids.hpp"
#include "protocol/split_set.hpp"

namespace driftmesh {

/// What all ranks know about all subdomains. Vertices of the whole mesh are numbered in this order: first the points of
/// the decomposition; then, subdomain by subdomain, the points on the roots that it owns (root by root, in order of
/// position), and those inside it.
struct SubdomainTable {
  IdVector<SubdomainId, Rank> rank;                  ///< the holder of each
  IdVector<SubdomainId, std::int64_t> first_number;  ///< number of the first vertex that is its own
  std::int64_t points = 0;                           ///< points in the whole mesh
  std::int64_t triangles = 0;                        ///< triangles in the whole mesh
};

/// The points on a root, as known to the rank on one or both of its sides.
struct NumberedRoot {
  GlobalRootId root{};
  protocol::SplitDigest splits;
  std::int64_t first_number = -1;  ///< number of the first point, in order of position; -1 while unknown
};

}  // namespace driftmesh
