#include "balancer/joint_plan.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "balancer/remap_parts.hpp"
#include "balancer/surplus.hpp"

namespace driftmesh::balancer {
namespace {

std::size_t index(Rank rank) {
  return static_cast<std::size_t>(rank);
}

/// Whether a subdomain may leave: it has not come just now, and to pack it takes less than to finish it.
class Movable {
 public:
  Movable(const Contribution& contribution, const MoveCost& cost) : contribution_(contribution), cost_(cost) {}

  bool operator()(const SubdomainState& s) const {
    const double speed = contribution_.state.speed;
    if (std::binary_search(contribution_.settled.begin(), contribution_.settled.end(), s.id)) return false;
    return speed <= 0 || cost_.for_giver(s.bytes, speed) < s.remaining / speed;
  }

 private:
  const Contribution& contribution_;
  const MoveCost& cost_;
};

/// Bundles as if each were one subdomain, numbered in their order.
LoadSnapshot as_subdomains(const std::vector<RankState>& states, std::span<const Bundle> bundles) {
  LoadSnapshot snapshot;
  snapshot.ranks = states;
  for (const Bundle& b : bundles)
    snapshot.subdomains.push_back({static_cast<SubdomainId>(snapshot.subdomains.size()), b.holder, b.work, b.bytes, 0});
  return snapshot;
}

std::vector<Offer> by_number(std::span<const Offer> offers) {
  std::vector<Offer> sorted(offers.begin(), offers.end());
  std::sort(sorted.begin(), sorted.end(),
            [](const Offer& a, const Offer& b) { return a.subdomain.id < b.subdomain.id; });
  return sorted;
}

/// The rank that each offer, in the order of their numbers, goes to in the end.
std::vector<Rank> deal_offers(const std::vector<Offer>& offers, const DealtParts& dealt, const Dealing& dealing) {
  LoadSnapshot snapshot;
  snapshot.ranks = dealt.states;
  for (const Offer& offer : offers) snapshot.subdomains.push_back(offer.subdomain);
  if (dealing.polish) snapshot = deal_surplus(snapshot, dealing.tolerance);
  std::vector<Rank> takers;
  for (const SubdomainState& s : snapshot.subdomains) takers.push_back(s.owner);
  return takers;
}

/// What is left of the bundles when the offers are taken out; empty ones stay, with no work.
std::vector<Bundle> without(std::span<const Bundle> bundles, const std::vector<Offer>& offers) {
  std::map<std::pair<Rank, Rank>, std::size_t> place;
  std::vector<Bundle> rest(bundles.begin(), bundles.end());
  for (std::size_t i = 0; i < rest.size(); ++i) place[{rest[i].holder, rest[i].part}] = i;
  for (const Offer& offer : offers) {
    Bundle& bundle = rest[place.at({offer.holder, offer.part})];
    bundle.work = std::max(0.0, bundle.work - offer.subdomain.remaining);
    bundle.bytes -= std::min(bundle.bytes, offer.subdomain.bytes);
    --bundle.count;
  }
  return rest;
}

}  // namespace

LoadSnapshot own_snapshot(const Contribution& contribution, std::shared_ptr<const Layout> layout,
                          std::vector<RankState> states) {
  return {std::move(layout), contribution.own, std::move(states)};
}

std::vector<Bundle> bundles_of(const Contribution& contribution, std::span<const Rank> parts, const MoveCost& cost) {
  const Movable movable(contribution, cost);
  std::map<Rank, Bundle> of_part;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SubdomainState& s = contribution.own[i];
    if (!movable(s)) continue;
    Bundle& bundle = of_part[parts[i]];
    bundle.work += s.remaining;
    bundle.bytes += s.bytes;
    ++bundle.count;
  }
  std::vector<Bundle> bundles;
  for (const auto& [part, sum] : of_part) bundles.push_back({contribution.rank, part, sum.work, sum.bytes, sum.count});
  return bundles;
}

DealtParts deal_parts(const std::vector<RankState>& states, std::span<const Bundle> bundles, double tolerance) {
  const LoadSnapshot snapshot = as_subdomains(states, bundles);
  std::vector<Rank> parts;
  for (const Bundle& bundle : bundles) parts.push_back(bundle.part);
  const std::vector<Rank> takers = remap_parts(snapshot, parts, tolerance);
  // A part that nobody holds any of is nobody's matter.
  DealtParts dealt{std::vector<Rank>(states.size(), 0), states};
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    dealt.rank_of[index(bundles[i].part)] = takers[i];
    dealt.states[index(bundles[i].holder)].remaining -= bundles[i].work;
    dealt.states[index(takers[i])].remaining += bundles[i].work;
  }
  for (RankState& state : dealt.states) state.remaining = std::max(0.0, state.remaining);
  return dealt;
}

std::vector<Offer> offers_of(const Contribution& contribution, std::span<const Rank> parts, const DealtParts& dealt,
                             const MoveCost& cost, const Dealing& dealing) {
  if (!dealing.polish) return {};
  const Movable movable(contribution, cost);
  std::vector<Offer> easiest_first;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!movable(contribution.own[i])) continue;
    Offer offer{contribution.rank, parts[i], contribution.own[i]};
    offer.subdomain.owner = dealt.rank_of[index(parts[i])];
    easiest_first.push_back(offer);
  }
  std::sort(easiest_first.begin(), easiest_first.end(),
            [](const Offer& a, const Offer& b) { return leaves_before(a.subdomain, b.subdomain); });

  LoadSnapshot planned;
  planned.ranks = dealt.states;
  const double ideal = ideal_time(planned);
  const std::vector<double> speeds = assumed_speeds(dealt.states);
  std::vector<double> surplus;
  for (std::size_t r = 0; r < speeds.size(); ++r) {
    const double share = ideal * speeds[r];
    const bool too_much = dealt.states[r].remaining > share * (1 + dealing.tolerance);
    surplus.push_back(too_much ? dealt.states[r].remaining - share : 0);
  }
  std::vector<Offer> offers;
  for (const Offer& offer : easiest_first) {
    double& left = surplus[index(offer.subdomain.owner)];
    if (left <= 0) continue;
    left -= offer.subdomain.remaining;
    offers.push_back(offer);
  }
  return offers;
}

JointPlan conclude(const std::vector<RankState>& states, std::span<const Bundle> bundles,
                   std::span<const Offer> all_offers, const DealtParts& dealt, const Dealing& dealing,
                   const MoveCost& cost, const Worth& worth) {
  const std::vector<Offer> offers = by_number(all_offers);
  const std::vector<Rank> takers = deal_offers(offers, dealt, dealing);
  const std::vector<Bundle> rest = without(bundles, offers);

  // All that could move, as if each were one subdomain: bundles first, then offers.
  LoadSnapshot before = as_subdomains(states, rest);
  std::vector<Move> wanted;
  const auto want = [&](std::size_t i, Rank from, Rank to) {
    if (from != to) wanted.push_back({static_cast<SubdomainId>(i), to});
  };
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (rest[i].count > 0) want(i, rest[i].holder, dealt.rank_of[index(rest[i].part)]);
  for (std::size_t i = 0; i < offers.size(); ++i) {
    SubdomainState s = offers[i].subdomain;
    s.id = static_cast<SubdomainId>(before.subdomains.size());
    s.owner = offers[i].holder;
    before.subdomains.push_back(s);
    want(rest.size() + i, offers[i].holder, takers[i]);
  }

  JointPlan plan{{}, {}, states, std::vector<JointPlan::Coming>(states.size())};
  for (const Move& move : worth_moving(before, wanted, cost, worth)) {
    const SubdomainState& s = before.subdomains[index(move.subdomain)];
    plan.states[index(s.owner)].remaining -= s.remaining;
    plan.states[index(move.destination)].remaining += s.remaining;
    const auto i = static_cast<std::size_t>(s.id);
    JointPlan::Coming& coming = plan.coming[index(move.destination)];
    coming.work += s.remaining;
    coming.count += i < rest.size() ? rest[i].count : 1;
    if (i < rest.size())
      plan.flows.push_back({rest[i].holder, rest[i].part, move.destination});
    else
      plan.moves.push_back({offers[i - rest.size()].subdomain.id, move.destination});
  }
  std::sort(plan.flows.begin(), plan.flows.end(),
            [](const auto& a, const auto& b) { return std::pair(a.from, a.part) < std::pair(b.from, b.part); });
  return plan;
}

std::vector<Move> moves_of(const Contribution& contribution, std::span<const Rank> parts,
                           const std::vector<Offer>& own_offers, const JointPlan& plan, const MoveCost& cost) {
  const Movable movable(contribution, cost);
  std::map<Rank, Rank> taker_of_part;
  for (const JointPlan::Flow& flow : plan.flows)
    if (flow.from == contribution.rank) taker_of_part[flow.part] = flow.to;
  std::map<SubdomainId, Rank> offered;  // stays here, unless it was dealt to another rank
  for (const Offer& offer : own_offers) offered[offer.subdomain.id] = contribution.rank;
  for (const Move& move : plan.moves)
    if (const auto own = offered.find(move.subdomain); own != offered.end()) own->second = move.destination;

  std::vector<Move> moves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SubdomainState& s = contribution.own[i];
    const auto single = offered.find(s.id);
    const auto flow = taker_of_part.find(parts[i]);
    Rank to = contribution.rank;
    if (single != offered.end())
      to = single->second;
    else if (flow != taker_of_part.end() && movable(s))
      to = flow->second;
    if (to != contribution.rank) moves.push_back({s.id, to});
  }
  return moves;
}

}  // namespace driftmesh::balancer
