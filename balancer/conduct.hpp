#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "balancer/messages.hpp"
#include "balancer/move_cost.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The rank that plans for all, or calls them together.
inline constexpr Rank kLeadingRank{0};

struct ControllerOptions {
  double look = 1e-2;      ///< seconds between two looks at the rank's own load
  double gap = 0.02;       ///< seconds between two reports of a rank, and between two plans, at least
  double interval = 1;     ///< seconds between two reports of a rank with work, at most
  double change = 0.1;     ///< a forecast that is off by this share is reported (see ReportRule)
  int refusals = 8;        ///< after so many in a row a rank asks for no more work until it was given some
  double overhead = 0.01;  ///< share of the time that planning may take
  MoveCost cost;
  Worth worth;

  /// Seconds that a move which was planned is waited for.
  [[nodiscard]] double patience() const { return 3 * interval; }
};

/// What a rank does for balance at one moment.
struct Decision {
  std::vector<Move> moves;  ///< hand these over, now
  std::vector<Outgoing> messages;
  bool planned = false;  ///< whether to plan was looked at, which may have taken long: tell took()
};

/// What a rank tells the controller at one moment.
struct Situation {
  double now = 0;
  std::span<const ReportedLoad> own;
  double speed = 0;
};

/// Of all subdomains in `own`, the work.
[[nodiscard]] inline double total_work(std::span<const ReportedLoad> own) {
  double total = 0;
  for (const ReportedLoad& load : own) total += load.remaining;
  return total;
}

/// What a rank has to do, in ascending order of the numbers.
[[nodiscard]] inline std::vector<SubdomainLoad> states_of(Rank owner, std::span<const ReportedLoad> own) {
  std::vector<SubdomainLoad> states;
  for (const ReportedLoad& load : own)
    states.push_back({load.subdomain, owner, load.remaining, load.bytes, static_cast<std::int32_t>(states.size())});
  std::ranges::sort(states, {}, &SubdomainLoad::id);
  return states;
}

/// The news of a rank, `number` counting them from 1. What is worked on now cannot be given away.
[[nodiscard]] inline LoadNews news_of(std::uint32_t number, double speed, std::span<const ReportedLoad> own) {
  const double total = total_work(own);
  return {number, total, own.empty() ? 0 : total - own.front().remaining, speed};
}

}  // namespace driftmesh::balancer
