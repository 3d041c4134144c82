#include "balancer/simulated/simulated_council.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "balancer/plan_jointly.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::balancer {
namespace {

/// Collective operations on the way from loads to decisions (see plan_jointly).
constexpr double kOwnOperations = 4;

/// And those of Zoltan, as counted on 2, 4 and 8 real ranks: rcb 60, 81 and 96, hsfc 44, 41 and 41, graph 280, 539 and
/// 489.
double operations(const std::string& kind, std::size_t ranks) {
  if (kind == "graph" || kind == "hypergraph") return 200 + 100 * bisections(ranks);
  return kind == "hsfc" ? 42 : 45 + 17 * bisections(ranks);
}

}  // namespace

SimulatedCouncil::SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                                   const ControllerOptions& options)
    : layout_(std::move(layout)), policy_(std::move(policy)), options_(options) {}

std::optional<Council::Decision> SimulatedCouncil::decide(std::uint32_t round, const Contribution& contribution) {
  Round& at = rounds_[round];
  if (at.contributions.try_emplace(contribution.rank, contribution).second) return std::nullopt;
  if (at.decisions.empty()) conclude_round(at);
  auto own = at.decisions.extract(contribution.rank);
  if (!own) throw Error("a rank decides twice in a round");
  for (const auto& [kind, units] : at.efforts) note_effort(kind.c_str(), units);
  if (at.decisions.empty()) rounds_.erase(round);
  return std::move(own.mapped());
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
  if (round.contributions.size() != to_index(layout_->ranks)) throw Error("a rank decides before all have come");
  std::vector<Contribution> contributions;
  IdVector<Rank, RankLoad> states;
  for (const auto& [rank, contribution] : round.contributions) {
    contributions.push_back(contribution);
    states.push_back(contribution.state);
  }
  std::vector<std::vector<Part>> parts;
  {
    const EffortLog log;
    parts = parts_of(contributions, states);
    for (const auto& [kind, units] : log.efforts()) {
      round.efforts[kind] = units / static_cast<double>(states.size());
      round.efforts["collective"] += operations(kind, states.size());
    }
  }
  const EffortLog log;
  // All ranks are here: their contributions are those of all ranks.
  auto decisions = plan_jointly(contributions, parts, states, policy_->dealing({layout_, {}, states}), options_,
                                [](const auto& told) { return told; });
  for (const auto& [kind, units] : log.efforts()) round.efforts[kind] += units;
  round.efforts["collective"] += kOwnOperations;
  for (const Contribution& c : contributions) round.decisions[c.rank] = std::move(decisions[to_index(c.rank)]);
}

std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                         std::shared_ptr<const Policy> policy,
                                                         const ControllerOptions& options) {
  if (!policy || policy->placement() != Placement::kCollective) return nullptr;
  return std::make_unique<SimulatedCouncil>(std::move(layout), std::move(policy), options);
}

}  // namespace driftmesh::balancer
