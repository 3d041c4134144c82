#include "balancer/joint_plan.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "balancer/remap_parts.hpp"
#include "balancer/surplus.hpp"
#include "protocol/packed_size.hpp"

namespace driftmesh::balancer {
namespace {

/// Whether a subdomain may leave: it fits in one message, has not just arrived, and takes less time to pack than to
/// finish.
class Movable {
 public:
  Movable(const Contribution& contribution, const MoveCost& cost) : contribution_(contribution), cost_(cost) {}

  bool operator()(const SubdomainLoad& s) const {
    const double speed = contribution_.state.speed;
    if (s.bytes > protocol::kMostPackedBytes) return false;
    if (std::binary_search(contribution_.settled.begin(), contribution_.settled.end(), s.id)) return false;
    return speed <= 0 || cost_.for_giver(s.bytes, speed) < s.remaining / speed;
  }

 private:
  const Contribution& contribution_;
  const MoveCost& cost_;
};

/// The bundles as if each were one subdomain, numbered in order.
LoadSnapshot as_subdomains(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles) {
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

/// Whether each rank has memory for all that comes to it.
bool fits_in_memory(const IdVector<Rank, RankLoad>& states, std::span<const Transfer> transfers) {
  IdVector<Rank, double> coming(states.size(), 0);
  for (const Transfer& t : transfers) coming[t.to] += memory_for({.remaining = t.work, .bytes = t.bytes});
  return std::ranges::all_of(ids_of(states), [&](Rank r) { return coming[r] <= states[r].free_memory; });
}

/// The bundles without the offers; empty bundles stay.
std::vector<Bundle> without(std::span<const Bundle> bundles, const std::vector<Offer>& offers) {
  std::map<std::pair<Rank, Part>, std::size_t> place;
  std::vector<Bundle> rest(bundles.begin(), bundles.end());
  for (std::size_t i = 0; i < rest.size(); ++i) place[{rest[i].holder, rest[i].part}] = i;
  for (const Offer& offer : offers) {
    Bundle& bundle = rest[place.at({offer.holder, offer.part})];
    bundle.work = std::max(0.0, bundle.work - offer.subdomain.remaining);
    bundle.bytes -= std::min(bundle.bytes, offer.subdomain.bytes);
  }
  return rest;
}

}  // namespace

LoadSnapshot own_snapshot(const Contribution& contribution, std::shared_ptr<const Layout> layout,
                          IdVector<Rank, RankLoad> states) {
  return {std::move(layout), contribution.own, std::move(states)};
}

std::vector<Bundle> bundles_of(const Contribution& contribution, std::span<const Part> parts, const MoveCost& cost) {
  const Movable movable(contribution, cost);
  std::map<Part, Bundle> of_part;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SubdomainLoad& s = contribution.own[i];
    if (!movable(s)) continue;
    Bundle& bundle = of_part[parts[i]];
    bundle.work += s.remaining;
    bundle.bytes += s.bytes;
  }
  std::vector<Bundle> bundles;
  for (const auto& [part, sum] : of_part) bundles.push_back({contribution.rank, part, sum.work, sum.bytes});
  return bundles;
}

DealtParts deal_parts(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles, double tolerance) {
  const LoadSnapshot snapshot = as_subdomains(states, bundles);
  std::vector<Part> parts;
  for (const Bundle& bundle : bundles) parts.push_back(bundle.part);
  const std::vector<Rank> takers = remap_parts(snapshot, parts, tolerance);
  // Parts held by no rank do not matter.
  DealtParts dealt{IdVector<Part, Rank>(states.size(), Rank{0}), states};
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    dealt.rank_of[bundles[i].part] = takers[i];
    dealt.states[bundles[i].holder].remaining -= bundles[i].work;
    dealt.states[takers[i]].remaining += bundles[i].work;
  }
  for (RankLoad& state : dealt.states) state.remaining = std::max(0.0, state.remaining);
  return dealt;
}

std::vector<Offer> offers_of(const Contribution& contribution, std::span<const Part> parts, const DealtParts& dealt,
                             const MoveCost& cost, const Dealing& dealing) {
  if (!dealing.polish) return {};
  const Movable movable(contribution, cost);
  std::vector<Offer> easiest_first;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!movable(contribution.own[i])) continue;
    Offer offer{contribution.rank, parts[i], contribution.own[i]};
    offer.subdomain.owner = dealt.rank_of[parts[i]];
    easiest_first.push_back(offer);
  }
  std::sort(easiest_first.begin(), easiest_first.end(),
            [](const Offer& a, const Offer& b) { return leaves_before(a.subdomain, b.subdomain); });

  LoadSnapshot planned;
  planned.ranks = dealt.states;
  const double ideal = ideal_time(planned);
  const IdVector<Rank, double> speeds = assumed_speeds(dealt.states);
  IdVector<Rank, double> surplus;
  for (const Rank r : ids_of(speeds)) {
    const double share = ideal * speeds[r];
    const bool too_much = dealt.states[r].remaining > share * (1 + dealing.tolerance);
    surplus.push_back(too_much ? dealt.states[r].remaining - share : 0);
  }
  std::vector<Offer> offers;
  for (const Offer& offer : easiest_first) {
    double& left = surplus[offer.subdomain.owner];
    if (left <= 0) continue;
    left -= offer.subdomain.remaining;
    offers.push_back(offer);
  }
  return offers;
}

DealtOffers deal_offers(const IdVector<Rank, RankLoad>& states, std::span<const Bundle> bundles,
                        std::span<const Offer> offers, const DealtParts& dealt, const Dealing& dealing,
                        const MoveCost& cost) {
  DealtOffers result{by_number(offers), {}, {}};
  LoadSnapshot offered;
  offered.ranks = dealt.states;
  for (const Offer& offer : result.offers) offered.subdomains.push_back(offer.subdomain);
  if (dealing.polish) offered = deal_surplus(offered, dealing.tolerance);
  for (const SubdomainLoad& s : offered.subdomains) result.takers.push_back(s.owner);

  // All that could move, as if each were one subdomain: the rest of the bundles, then the offers.
  const std::vector<Bundle> rest = without(bundles, result.offers);
  LoadSnapshot before = as_subdomains(states, rest);
  std::vector<Move> moves;
  for (std::size_t i = 0; i < rest.size(); ++i)
    moves.push_back({static_cast<SubdomainId>(i), dealt.rank_of[rest[i].part]});
  for (std::size_t i = 0; i < result.offers.size(); ++i) {
    SubdomainLoad s = result.offers[i].subdomain;
    s.id = static_cast<SubdomainId>(before.subdomains.size());
    s.owner = result.offers[i].holder;
    before.subdomains.push_back(s);
    moves.push_back({s.id, result.takers[i]});
  }
  result.times = finishing_times(before, moves, cost);
  return result;
}

std::vector<Move> moves_of(const Contribution& contribution, std::span<const Part> parts,
                           const IdVector<Rank, RankLoad>& states, const DealtParts& dealt, const DealtOffers& offers,
                           const MoveCost& cost, const Worth& worth) {
  const Movable movable(contribution, cost);
  std::map<SubdomainId, Rank> taker_of;
  for (std::size_t i = 0; i < offers.offers.size(); ++i)
    if (offers.offers[i].holder == contribution.rank) taker_of[offers.offers[i].subdomain.id] = offers.takers[i];
  const LoadSnapshot own = own_snapshot(contribution, nullptr, states);
  std::vector<Move> wanted;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SubdomainLoad& s = contribution.own[i];
    if (!movable(s)) continue;
    const auto offered = taker_of.find(s.id);
    wanted.push_back({s.id, offered == taker_of.end() ? dealt.rank_of[parts[i]] : offered->second});
  }
  const double last = *std::max_element(offers.times.begin(), offers.times.end());
  const double spare = std::max(last, ideal_time(own) * (1 + worth.slack)) - offers.times[contribution.rank];
  return needed_moves(own, wanted, cost, contribution.rank, spare);
}

std::vector<Transfer> transfers_of(const Contribution& contribution, std::span<const Move> moves) {
  const LoadSnapshot own{nullptr, contribution.own, {}};
  std::map<Rank, Transfer> to;
  for (const Move& move : moves) {
    const SubdomainLoad& s = *find(own, move.subdomain);
    Transfer& transfer = to[move.destination];
    transfer.work += s.remaining;
    transfer.bytes += s.bytes;
    ++transfer.count;
  }
  std::vector<Transfer> transfers;
  for (const auto& [rank, sum] : to) transfers.push_back({contribution.rank, rank, sum.work, sum.bytes, sum.count});
  return transfers;
}

JointPlan weigh(const IdVector<Rank, RankLoad>& states, std::span<const Transfer> transfers, const MoveCost& cost,
                const Worth& worth) {
  JointPlan plan{false, states, IdVector<Rank, JointPlan::Coming>(states.size())};
  LoadSnapshot before{nullptr, {}, states};
  be_sure_of_idle_ranks(before);
  std::vector<Move> moves;
  for (const Transfer& t : transfers) {
    const auto id = static_cast<SubdomainId>(before.subdomains.size());
    before.subdomains.push_back({id, t.from, t.work, t.bytes, 0});
    moves.push_back({id, t.to});
  }
  const double now = finishing_time(before);
  const IdVector<Rank, double> times = finishing_times(before, moves, cost);
  const double saved = gain_beyond(noise_of(before), now - *std::max_element(times.begin(), times.end()));
  plan.worth = saved > 0 && saved >= worth.gain * now && saved >= worth.seconds && fits_in_memory(states, transfers);
  if (!plan.worth) return plan;
  for (const Transfer& t : transfers) {
    plan.states[t.from].remaining -= t.work;
    plan.states[t.to].free_memory -= t.work;
    plan.states[t.to].remaining += t.work;
    plan.coming[t.to].work += t.work;
    plan.coming[t.to].count += t.count;
  }
  return plan;
}

}  // namespace driftmesh::balancer
