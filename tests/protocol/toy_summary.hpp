#pragma once

#include <cstdint>
#include <vector>

#include "protocol/toy_rank.hpp"

namespace driftmesh::protocol::toy {

/// For each edge, the digest of one side's points minus that of the other's: the sum over all ranks is 0 if both sides
/// agree. Then the numbers of subdomains, of their points, and of hand-offs.
inline std::vector<std::uint64_t> summary(const World& world, const ToyRank& rank) {
  std::vector<std::uint64_t> values(world.edges.size() + 3, 0);
  for (const auto& [id, subdomain] : rank.subdomains()) {
    ++values[world.edges.size()];
    for (const auto& [edge, paths] : subdomain.points()) {
      SplitDigest digest;
      for (const auto path : paths) digest.add(path);
      values[to_index(edge)] += world.edges[edge].one == id ? digest.sum : 0 - digest.sum;
      values[world.edges.size() + 1] += digest.count;
    }
  }
  values.back() = static_cast<std::uint64_t>(rank.protocol().counters().hand_offs);
  return values;
}

}  // namespace driftmesh::protocol::toy
