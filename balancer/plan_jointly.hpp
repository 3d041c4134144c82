#pragma once

#include <span>
#include <utility>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "balancer/joint_plan.hpp"

namespace driftmesh::balancer {

/// From parts to decisions: the steps of joint_plan.hpp in order, for the ranks in this process, `here`. `parts` lists
/// the parts of each rank's subdomains. `from_all(told)` exchanges the contributions of a step: given those of the
/// ranks here, it returns those of all ranks, in the same order everywhere.
template <class FromAll>
[[nodiscard]] std::vector<Council::Decision> plan_jointly(std::span<const Contribution> here,
                                                          const std::vector<std::vector<Part>>& parts,
                                                          const IdVector<Rank, RankLoad>& states,
                                                          const Dealing& dealing, const ControllerOptions& options,
                                                          const FromAll& from_all) {
  const MoveCost& cost = options.cost;
  // What `tell(i)` has for rank i of those here, and then of all.
  const auto told_by_all = [&]<class Tell>(const Tell& tell) {
    decltype(tell(0)) told;
    for (std::size_t i = 0; i < here.size(); ++i) {
      const auto own = tell(i);
      told.insert(told.end(), own.begin(), own.end());
    }
    return from_all(told);
  };

  const auto bundles = told_by_all([&](std::size_t i) { return bundles_of(here[i], parts[i], cost); });
  const DealtParts dealt = deal_parts(states, bundles, dealing.tolerance);
  const auto offered = told_by_all([&](std::size_t i) { return offers_of(here[i], parts[i], dealt, cost, dealing); });
  const DealtOffers offers = deal_offers(states, bundles, offered, dealt, dealing, cost);

  std::vector<std::vector<Move>> moves;
  for (std::size_t i = 0; i < here.size(); ++i)
    moves.push_back(moves_of(here[i], parts[i], states, dealt, offers, cost, options.worth));
  const auto transfers = told_by_all([&](std::size_t i) { return transfers_of(here[i], moves[i]); });
  const JointPlan plan = weigh(states, transfers, cost, options.worth);

  std::vector<Council::Decision> decisions;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!plan.worth) moves[i].clear();
    decisions.push_back({std::move(moves[i]), plan.states, plan.coming[here[i].rank], plan.worth});
  }
  return decisions;
}

}  // namespace driftmesh::balancer
