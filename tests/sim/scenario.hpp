#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/adversarial_network.hpp"
#include "protocol/codec.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::sim {

/// What of a scenario is not left to the seed.
struct Choice {
  std::optional<std::string> domain;
  std::optional<std::int32_t> ranks;
  std::optional<bool> presplit;
  std::optional<std::size_t> aggregation;
  std::optional<std::string> mover;
};

/// Who moves subdomains: an adversary of Mover, or a balancer policy by its name; "collective" is Zoltan on all ranks.
[[nodiscard]] const std::vector<std::string>& mover_names();

/// How messages about subdomains that move are treated, beyond what the network does to any message.
enum class Mischief {
  kNone,
  kRacingHandOffs,  ///< each hand-off overtakes all SPLITs, or is overtaken by those of a long while
  kLateLocations,   ///< location updates arrive when all work is over
  kRumors,          ///< instead of a location update another one of this run may come, again and out of date
  kLateAdvice,      ///< plans, requests for work and answers take a long while
};

/// One run: everything but the domain's shape follows from the seed and the choice.
struct Scenario {
  std::uint64_t seed = 1;
  std::string domain;
  std::int32_t ranks = 1;
  std::int32_t subdomains = 1;
  bool presplit = false;
  std::size_t aggregation = 1;
  std::int64_t slice = 1;  ///< insertions
  WorkOrder order = WorkOrder::kGiven;
  double move_chance = 0;       ///< of handing a subdomain over, at each step of a rank
  bool sleep = false;           ///< finished subdomains sleep
  std::int64_t most_moves = 0;  ///< in the whole run; a policy's are not counted
  std::string mover;            ///< one of mover_names()
  bool lopsided = false;        ///< all subdomains start on one rank
  Mischief mischief = Mischief::kNone;
  protocol::Adversary adversary;

  [[nodiscard]] static Scenario from_seed(std::uint64_t seed, const Choice& choice = {});
  /// Whether `mover` is a policy: real controllers decide, in a time of which a step takes one unit.
  [[nodiscard]] bool balanced() const;
  /// "seed 7: ell in 9 subdomains on 5 ranks, ..."
  [[nodiscard]] std::string describe() const;
};

}  // namespace driftmesh::sim
