#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decompose/decomposition.hpp"
#include "runtime/subdomain_loop.hpp"
#include "support/split_points.hpp"

namespace driftmesh::testing {

/// Rank loops on a simulated network (AdversarialNetwork or VirtualNetwork), all in this process.
struct SimulatedRanks {
  IdVector<Rank, std::unique_ptr<SubdomainLoop>> loops;
  IdVector<Rank, protocol::RankStep> steps;

  template <class Network>
  SimulatedRanks(Network& network, std::int32_t ranks, const RunPlan& plan, const CostModel& costs = {}) {
    for (const Rank r : first_ids<Rank>(ranks))
      loops.push_back(std::make_unique<SubdomainLoop>(network.transport(r), plan, costs));
    for (const auto& loop : loops) steps.push_back([l = loop.get()] { return l->step(); });
  }

  [[nodiscard]] std::vector<const Subdomain*> subdomains() const {
    std::vector<const Subdomain*> all;
    for (const auto& loop : loops)
      for (const auto& [id, subdomain] : loop->subdomains()) all.push_back(&subdomain);
    return all;
  }
};

/// The problems of the parts as one mesh: subdomains that are missing or live twice, and shared edges whose sides have
/// different points.
inline std::vector<std::string> conformity_problems(const Decomposition& d,
                                                    const std::vector<const Subdomain*>& subdomains) {
  std::vector<std::string> problems;
  std::set<SubdomainId> seen;
  SplitPoints first;
  for (const Subdomain* s : subdomains) {
    if (!seen.insert(s->id()).second) problems.push_back("subdomain " + to_string(s->id()) + " lives twice");
    if (!s->started() || s->active()) {
      problems.push_back("subdomain " + to_string(s->id()) + " is not finished");
      continue;
    }
    for (const GlobalRootId r : not_conforming_roots(s->mesh(), first))
      problems.push_back("root " + to_string(r) + " of subdomain " + to_string(s->id()) + " does not conform");
  }
  if (seen.size() != d.size()) problems.push_back(std::to_string(d.size() - seen.size()) + " subdomains are missing");
  return problems;
}

}  // namespace driftmesh::testing
