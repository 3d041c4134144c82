#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "balancer/snapshot/messages.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The rank that plans for all.
inline constexpr Rank kLeadingRank{0};

/// The state of a rank as told to the controller.
struct Situation {
  double now = 0;
  std::span<const ReportedLoad> own;
  double speed = 0;
  double doubt = 0;                   ///< relative standard deviation of the time for `own` (see Experience)
  double free_memory = kAmpleMemory;  ///< as in RankLoad
};

/// Total work of the subdomains in `own`.
[[nodiscard]] inline double total_work(std::span<const ReportedLoad> own) {
  double total = 0;
  for (const ReportedLoad& load : own) total += load.remaining;
  return total;
}

/// The triangles for which a rank that takes it needs memory.
[[nodiscard]] inline double room_for(const ReportedLoad& load) {
  return memory_for(SubdomainLoad{.id = load.subdomain, .remaining = load.remaining, .bytes = load.bytes});
}

/// Takes a subdomain out of the load of a rank; false if it is not there.
inline bool take_out(std::vector<ReportedLoad>& own, SubdomainId id) {
  return std::erase_if(own, [&](const ReportedLoad& load) { return load.subdomain == id; }) > 0;
}

/// The load of a rank, in ascending order of IDs.
[[nodiscard]] inline std::vector<SubdomainLoad> states_of(Rank owner, std::span<const ReportedLoad> own) {
  std::vector<SubdomainLoad> states;
  for (const ReportedLoad& load : own)
    states.push_back({load.subdomain, owner, load.remaining, load.bytes, static_cast<std::int32_t>(states.size())});
  std::ranges::sort(states, {}, &SubdomainLoad::id);
  return states;
}

/// The news of a rank; `number` counts them from 1. The subdomain being worked on cannot be given away.
[[nodiscard]] inline LoadNews news_of(std::uint32_t number, const Situation& situation,
                                      std::span<const ReportedLoad> own) {
  const double total = total_work(own);
  return {number,          total,           own.empty() ? 0 : total - own.front().remaining,
          situation.speed, situation.doubt, situation.free_memory};
}

}  // namespace driftmesh::balancer
