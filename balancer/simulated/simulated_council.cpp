#include "balancer/simulated/simulated_council.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "balancer/plan_jointly.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::balancer {

SimulatedCouncil::SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                                   const ControllerOptions& options)
    : layout_(std::move(layout)), policy_(std::move(policy)), options_(options) {}

// A subdomain may have moved since its former owner announced it: list it only once.
void SimulatedCouncil::announce(std::uint32_t round, const Contribution& contribution) {
  last_ = std::max(last_, round);
  Round& at = rounds_[round];
  if (at.decided) return;
  Contribution& own = at.contributions[contribution.rank];
  for (const SubdomainLoad& s : own.own) at.listed.erase(s.id);
  own = contribution;
  std::erase_if(own.own, [&](const SubdomainLoad& s) { return !at.listed.insert(s.id).second; });
  // A rank announced here no longer decides in an earlier round.
  if (at.contributions.size() == to_index(layout_->ranks)) rounds_.erase(rounds_.begin(), rounds_.find(round));
}

Council::Decision SimulatedCouncil::decide(std::uint32_t round, const Contribution& contribution) {
  const auto at = rounds_.find(round);
  if (at == rounds_.end()) throw Error("a rank decides in a round that has not begun or is over");
  if (!std::exchange(at->second.decided, true)) conclude_round(at->second);
  auto own = at->second.decisions.extract(contribution.rank);
  if (!own) throw Error("a rank decides twice in a round, or without having announced itself");
  if (at->second.decisions.empty()) rounds_.erase(at);
  return std::move(own.mapped());
}

bool SimulatedCouncil::in_session() const {
  const auto last = rounds_.find(last_);
  return last != rounds_.end() && (!last->second.decided || last->second.decisions.contains(Rank{0}));
}

// Parts are made for all ranks at once; each rank gets those of its listed subdomains.
std::vector<std::vector<Part>> SimulatedCouncil::parts_of(const std::vector<Contribution>& contributions,
                                                          const IdVector<Rank, RankLoad>& states) const {
  LoadSnapshot all{layout_, {}, states};
  for (const Contribution& c : contributions) all.subdomains.insert(all.subdomains.end(), c.own.begin(), c.own.end());
  std::ranges::sort(all.subdomains, {}, &SubdomainLoad::id);
  const auto partitioning = policy_->partitioning(all);
  const std::vector<Part> parts = partitioning ? zoltan_partition(all, *partitioning) : present_parts(all);
  IdVector<SubdomainId, Part> part_of(layout_->subdomains.size());
  for (std::size_t i = 0; i < parts.size(); ++i) part_of[all.subdomains[i].id] = parts[i];
  std::vector<std::vector<Part>> of_rank;
  for (const Contribution& c : contributions) {
    std::vector<Part>& own = of_rank.emplace_back();
    for (const SubdomainLoad& s : c.own) own.push_back(part_of[s.id]);
  }
  return of_rank;
}

void SimulatedCouncil::conclude_round(Round& round) const {
  if (round.contributions.size() != to_index(layout_->ranks))
    throw Error("a rank decides before all have announced themselves");
  std::vector<Contribution> contributions;
  IdVector<Rank, RankLoad> states;
  for (const auto& [rank, contribution] : round.contributions) {
    contributions.push_back(contribution);
    states.push_back(contribution.state);
  }
  // All ranks are here: their contributions are those of all ranks.
  auto decisions =
      plan_jointly(contributions, parts_of(contributions, states), states, policy_->dealing({layout_, {}, states}),
                   options_, [](const auto& told) { return told; });
  for (const Contribution& c : contributions) round.decisions[c.rank] = std::move(decisions[to_index(c.rank)]);
}

std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                         std::shared_ptr<const Policy> policy,
                                                         const ControllerOptions& options) {
  if (!policy || policy->placement() != Placement::kCollective) return nullptr;
  return std::make_unique<SimulatedCouncil>(std::move(layout), std::move(policy), options);
}

}  // namespace driftmesh::balancer
