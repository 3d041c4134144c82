#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocol/adversarial_network.hpp"
#include "protocol/codec.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::sim {

/// What of a scenario is not left to the seed.
struct Choice {
  std::optional<std::string> domain;
  std::optional<protocol::Rank> ranks;
  std::optional<bool> presplit;
  std::optional<std::size_t> aggregation;
};

/// One run: everything but the domain's shape follows from the seed and the choice.
struct Scenario {
  std::uint64_t seed = 1;
  std::string domain;
  protocol::Rank ranks = 1;
  std::int32_t subdomains = 1;
  bool presplit = false;
  std::size_t aggregation = 1;
  std::int64_t slice = 1;  ///< insertions
  WorkOrder order = WorkOrder::kGiven;
  double move_chance = 0;       ///< of handing a subdomain over, at each step of a rank
  bool sleep = false;           ///< finished subdomains sleep
  std::int64_t most_moves = 0;  ///< in the whole run
  protocol::Adversary adversary;

  [[nodiscard]] static Scenario from_seed(std::uint64_t seed, const Choice& choice = {});
  /// "seed 7: ell in 9 subdomains on 5 ranks, ..."
  [[nodiscard]] std::string describe() const;
};

}  // namespace driftmesh::sim
