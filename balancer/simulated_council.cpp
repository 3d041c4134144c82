#include "balancer/simulated_council.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.hpp"

namespace driftmesh::balancer {

SimulatedCouncil::SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                                   const ControllerOptions& options)
    : layout_(std::move(layout)), policy_(std::move(policy)), options_(options) {}

// A subdomain may have moved since its former owner announced itself: it is listed once.
void SimulatedCouncil::announce(std::uint32_t round, const Contribution& contribution) {
  last_ = std::max(last_, round);
  Round& at = rounds_[round];
  if (at.decided) return;
  Contribution& own = at.contributions[contribution.rank];
  for (const SubdomainState& s : own.own) at.listed.erase(s.id);
  own = contribution;
  std::erase_if(own.own, [&](const SubdomainState& s) { return !at.listed.insert(s.id).second; });
  // Who has announced itself here decides in no earlier round any more.
  if (at.contributions.size() == index(layout_->ranks)) rounds_.erase(rounds_.begin(), rounds_.find(round));
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
  return last != rounds_.end() && (!last->second.decided || last->second.decisions.contains(0));
}

// Parts are made for all at once, and given to each rank for what it listed.
std::vector<std::vector<Rank>> SimulatedCouncil::parts_of(const Round& round,
                                                          const std::vector<RankState>& states) const {
  LoadSnapshot all{layout_, {}, states};
  for (const auto& [rank, contribution] : round.contributions)
    all.subdomains.insert(all.subdomains.end(), contribution.own.begin(), contribution.own.end());
  std::sort(all.subdomains.begin(), all.subdomains.end(),
            [](const SubdomainState& a, const SubdomainState& b) { return a.id < b.id; });
  const std::vector<Rank> parts = policy_->parts(all, std::nullopt);
  std::vector<std::vector<Rank>> of_rank;
  for (const auto& [rank, contribution] : round.contributions) {
    std::vector<Rank>& own = of_rank.emplace_back();
    for (const SubdomainState& s : contribution.own)
      own.push_back(parts[static_cast<std::size_t>(find(all, s.id) - all.subdomains.data())]);
  }
  return of_rank;
}

void SimulatedCouncil::conclude_round(Round& round) const {
  if (round.contributions.size() != static_cast<std::size_t>(layout_->ranks))
    throw Error("a rank decides before all have announced themselves");
  const MoveCost& cost = options_.cost;
  std::vector<RankState> states;
  for (const auto& [rank, contribution] : round.contributions) states.push_back(contribution.state);
  const Dealing dealing = policy_->dealing({layout_, {}, states});
  const auto parts = parts_of(round, states);

  std::vector<Bundle> bundles;
  for (const auto& [rank, contribution] : round.contributions) {
    const auto own = bundles_of(contribution, parts[index(rank)], cost);
    bundles.insert(bundles.end(), own.begin(), own.end());
  }
  const DealtParts dealt = deal_parts(states, bundles, dealing.tolerance);

  std::vector<Offer> offered;
  for (const auto& [rank, contribution] : round.contributions) {
    const auto own = offers_of(contribution, parts[index(rank)], dealt, cost, dealing);
    offered.insert(offered.end(), own.begin(), own.end());
  }
  const DealtOffers offers = deal_offers(states, bundles, offered, dealt, dealing, cost);

  std::vector<std::vector<Move>> moves;
  std::vector<Transfer> transfers;
  for (const auto& [rank, contribution] : round.contributions) {
    const auto r = index(rank);
    moves.push_back(moves_of(contribution, parts[r], states, dealt, offers, cost, options_.worth));
    const auto own = transfers_of(contribution, moves.back());
    transfers.insert(transfers.end(), own.begin(), own.end());
  }
  const JointPlan plan = weigh(states, transfers, cost, options_.worth);
  for (const auto& [rank, contribution] : round.contributions)
    round.decisions[rank] = decision_of(contribution, std::move(moves[index(rank)]), plan);
}

std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                         std::shared_ptr<const Policy> policy,
                                                         const ControllerOptions& options) {
  if (!policy || policy->placement() != Placement::kCollective) return nullptr;
  return std::make_unique<SimulatedCouncil>(std::move(layout), std::move(policy), options);
}

}  // namespace driftmesh::balancer
