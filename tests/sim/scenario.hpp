#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/codec.hpp"
#include "runtime/run_plan.hpp"
#include "support/adversarial_network.hpp"

namespace driftmesh::sim {

/// The parameters of a scenario that are not left to the seed.
struct Choice {
  std::optional<std::string> domain;
  std::optional<std::int32_t> ranks;
  std::optional<bool> presplit;
  std::optional<std::size_t> aggregation;
  std::optional<std::string> mover;
};

/// What moves subdomains: an adversary of Mover, or a policy by its name.
[[nodiscard]] const std::vector<std::string>& mover_names();

/// How messages about subdomains that move are treated, beyond what the network does to any message.
enum class Mischief {
  kNone,
  kRacingHandOffs,  ///< each hand-off overtakes all SPLITs, or is overtaken by many of them
  kLateLocations,   ///< location updates arrive when all work is done
  kStaleLocations,  ///< location updates may be replaced by earlier, outdated ones
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
  double move_chance = 0;        ///< probability that a rank hands a subdomain over in a step
  bool sleep = false;            ///< finished subdomains sleep
  std::size_t crew = 0;          ///< threads of each rank besides its own
  std::int64_t most_moves = 0;   ///< in the whole run, not counting those of a policy
  std::string mover;             ///< one of mover_names()
  std::int32_t arity = 1;        ///< arity of the tree over which termination is detected
  bool short_of_memory = false;  ///< ranks have room for little more than what they begin with
  bool lopsided = false;         ///< all subdomains start on one rank
  Mischief mischief = Mischief::kNone;
  protocol::Adversary adversary;

  [[nodiscard]] static Scenario from_seed(std::uint64_t seed, const Choice& choice = {});
  /// Whether `mover` is a policy: real controllers decide, and each step takes one unit of time.
  [[nodiscard]] bool balanced() const;
  /// "seed 7: ell in 9 subdomains on 5 ranks, ..."
  [[nodiscard]] std::string describe() const;
};

}  // namespace driftmesh::sim
