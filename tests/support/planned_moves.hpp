#pragma once

#include <doctest/doctest.h>

#include <set>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::testing {

/// Moves must take listed subdomains that are not fixed, each once, to another rank that there is.
inline void check_valid(const balancer::LoadSnapshot& snapshot, const std::vector<balancer::Move>& moves) {
  std::set<SubdomainId> moved;
  for (const balancer::Move& move : moves) {
    CAPTURE(to_int(move.subdomain));
    const balancer::SubdomainLoad* const s = find(snapshot, move.subdomain);
    REQUIRE(s != nullptr);
    REQUIRE(!s->fixed);
    REQUIRE(move.destination != s->owner);
    REQUIRE(snapshot.ranks.has(move.destination));
    REQUIRE(moved.insert(move.subdomain).second);
  }
}

/// The triangles for which each rank needs memory because of the moves.
[[nodiscard]] inline IdVector<Rank, double> memory_needed(const balancer::LoadSnapshot& snapshot,
                                                          const std::vector<balancer::Move>& moves) {
  IdVector<Rank, double> needed(snapshot.ranks.size(), 0);
  for (const balancer::Move& move : moves) needed[move.destination] += memory_for(*find(snapshot, move.subdomain));
  return needed;
}

}  // namespace driftmesh::testing
