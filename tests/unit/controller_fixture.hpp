// Ranks that balance, told by hand what they have and what others say.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "balancer/controller.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"

namespace driftmesh::testing {

using Loads = std::vector<balancer::ReportedLoad>;

/// Subdomains first .. last, of equal work, in epoch 0.
inline Loads loads_of(std::int32_t first, std::int32_t last, double work) {
  Loads loads;
  for (std::int32_t s = first; s <= last; ++s) loads.push_back({SubdomainId{s}, 0, work, 40});
  return loads;
}

/// Without waiting until a rank runs out of work soon.
inline balancer::ControllerOptions planning_early() {
  balancer::ControllerOptions options;
  options.ahead = 1;
  return options;
}

inline balancer::Controller controller_of(Rank self, const balancer::Layout& layout, const std::string& policy,
                                          double start = 0) {
  return {self, std::make_shared<balancer::Layout>(layout), balancer::make_policy(policy), {}, start};
}

/// The messages of one kind, each with its destination.
template <class M>
std::vector<std::pair<Rank, M>> sent(const balancer::Decision& decision) {
  std::vector<std::pair<Rank, M>> found;
  for (const auto& o : decision.messages)
    if (const auto* const m = std::get_if<M>(&o.message)) found.emplace_back(o.destination, *m);
  return found;
}

}  // namespace driftmesh::testing
