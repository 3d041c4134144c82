#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "balancer/experience.hpp"
#include "balancer/messages.hpp"
#include "balancer/move_cost.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The rank that plans for all.
inline constexpr Rank kLeadingRank{0};

struct ControllerOptions {
  double look = defaults::kLook;          ///< seconds between checks of the rank's own load
  double gap = defaults::kGap;            ///< shortest time in seconds between reports of a rank, and between plans
  double interval = defaults::kInterval;  ///< longest time in seconds between reports of a rank with work
  double change = 0.1;                    ///< a forecast that is off by this fraction is reported (see ReportRule)
  int refusals = 8;                ///< after this many in a row a rank stops asking for work until it is given some
  double ahead = 0.25;             ///< fraction of the time left: a rank that runs out of work within it gets more
  double overhead = 0.01;          ///< fraction of the time that planning may take
  double reference_speed = 7.9e6;  ///< triangles a second of a rank that plans as fast as Policy::planning_seconds says
  double work_to_start = kWorkToStart;  ///< triangles that take as long as the start of a subdomain
  MoveCost cost;
  Worth worth;

  /// From asking for work to having it, in seconds: a look at the load, the way to rank 0, to the giver and back.
  [[nodiscard]] double time_to_get_work() const { return look + 3 * cost.latency; }
  /// How many triangles a rank makes before it looks at its messages again: at most that many, and on a slow rank no
  /// more than it makes between two checks of its load, so that what it is asked or advised does not wait.
  [[nodiscard]] double triangles_between_looks(double most, double speed) const {
    constexpr double kLeast = 128, kWhileUnknown = 512;  // fewer cost more than they help
    return std::min(most, speed > 0 ? std::max(kLeast, look * speed) : kWhileUnknown);
  }
  /// How long before a rank runs out of work others should give it some, in seconds, if so much time is left and a plan
  /// takes so long. Not sooner: forecasts get better, and borders between what stays and what moves become settled.
  [[nodiscard]] double time_ahead(double left, double planning) const {
    return std::max({ahead * left, 8 * time_to_get_work(), 4 * planning});
  }
  /// How long a subdomain stays where it has come to, in seconds, if so much time is left.
  [[nodiscard]] double rest_after_move(double left) const { return std::min(interval, left / 20); }
  /// How long to wait for a planned move, in seconds.
  [[nodiscard]] double patience() const { return 3 * interval; }
};

/// Balancing actions of a rank at one moment.
struct Decision {
  std::vector<Move> moves;  ///< hand these over, now
  std::vector<Move> asks;   ///< moves that their destinations are to be asked for first (see Admissions)
  std::vector<Outgoing> messages;
  bool planned = false;  ///< planning was considered, which may have taken long: call took()
};

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
