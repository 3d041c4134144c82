#include "balancer/planner/surplus.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "balancer/planner/ranks_by_finish.hpp"
#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {
namespace {

using Index = std::size_t;  // into the listed subdomains

constexpr Index kUnlisted = SIZE_MAX;

class Dealer {
 public:
  Dealer(const LoadSnapshot& snapshot, double tolerance)
      : snapshot_(snapshot),
        tolerance_(tolerance),
        ideal_(ideal_time(snapshot)),
        limit_(ideal_),
        speeds_(assumed_speeds(snapshot.ranks)),
        index_(snapshot.layout ? snapshot.layout->subdomains.size() : 0, kUnlisted),
        border_(snapshot.subdomains.size()),
        gone_(snapshot.subdomains.size(), false) {
    if (!snapshot.layout) return;
    for (Index i = 0; i < snapshot.subdomains.size(); ++i) index_[snapshot.subdomains[i].id] = i;
  }

  /// Subdomains that are neighbors stay together where ranks have room for them until `limit`, in seconds.
  LoadSnapshot deal_together(double limit) {
    limit_ = limit;
    std::vector<Index> left;
    const std::vector<Index> pool = collect();
    RanksByFinish takers = takers_of(pool);
    for (const Index i : pool)
      if (!place_next_to_neighbors(i, takers)) left.push_back(i);
    deal_singly(std::move(left), takers);
    return std::move(snapshot_);
  }
  /// Largest first, each to the rank that would finish it first.
  LoadSnapshot deal_singly() {
    std::vector<Index> pool = collect();
    RanksByFinish takers = takers_of(pool);
    deal_singly(std::move(pool), takers);
    return std::move(snapshot_);
  }

 private:
  void deal_singly(std::vector<Index> pool, RanksByFinish& takers) {
    std::ranges::sort(pool, {}, [&](Index i) {
      const SubdomainLoad& s = snapshot_.subdomains[i];
      return std::tuple(-s.remaining, s.id);
    });
    for (const Index i : pool) place_earliest(i, takers);
    note_effort("search", static_cast<double>(takers.examined()));
  }

  [[nodiscard]] RanksByFinish takers_of(const std::vector<Index>& pool) const {
    note_effort("place", static_cast<double>(pool.size()));
    note_effort("search", static_cast<double>(speeds_.size()));
    double work = 0;
    for (const Index i : pool) work += snapshot_.subdomains[i].remaining;
    IdVector<Rank, double> loads;
    for (const RankLoad& rank : snapshot_.ranks) loads.push_back(rank.remaining);
    return {loads, speeds_, work / static_cast<double>(std::max<std::size_t>(pool.size(), 1))};
  }

  double& load(Rank rank) { return snapshot_.ranks[rank].remaining; }
  /// The work that a rank does within the limit.
  [[nodiscard]] double share(Rank rank) const { return limit_ * speeds_[rank]; }

  [[nodiscard]] std::span<const Neighbor> neighbors_of(Index i) const {
    if (!snapshot_.layout) return {};
    return (*snapshot_.layout)[snapshot_.subdomains[i].id].neighbors;
  }
  /// The neighbor of `i`, if it is listed and the border to it counts.
  [[nodiscard]] Index open(Index i, const Neighbor& neighbor) const {
    const Index j = index_[neighbor.subdomain];
    if (j == kUnlisted || !is_open_border(snapshot_, snapshot_.subdomains[i], snapshot_.subdomains[j]))
      return kUnlisted;
    return j;
  }
  /// The same, if it still belongs to this rank.
  [[nodiscard]] Index staying(Index i, const Neighbor& neighbor, Rank r) const {
    const Index j = open(i, neighbor);
    return j != kUnlisted && snapshot_.subdomains[j].owner == r && !gone_[j] ? j : kUnlisted;
  }
  /// Whether the neighbor has left its rank, or is where work is lacking.
  [[nodiscard]] bool is_where_work_goes(Index i, const Neighbor& neighbor) const {
    const Index j = open(i, neighbor);
    if (j == kUnlisted) return false;
    const Rank r = snapshot_.subdomains[j].owner;
    return gone_[j] || snapshot_.ranks[r].remaining < ideal_ * speeds_[r] * (1 - tolerance_);
  }

  /// The surplus of all ranks.
  std::vector<Index> collect() {
    note_effort("deal", static_cast<double>(snapshot_.subdomains.size()));
    IdVector<Rank, std::vector<Index>> own(snapshot_.ranks.size());
    for (Index i = 0; i < snapshot_.subdomains.size(); ++i)
      if (!snapshot_.subdomains[i].fixed) own[snapshot_.subdomains[i].owner].push_back(i);
    std::vector<Index> pool;
    for (const Rank r : ids_of(own))
      if (load(r) > std::max(limit_, ideal_ * (1 + tolerance_)) * speeds_[r]) peel(r, own[r], pool);
    return pool;
  }

  /// Adds the surplus of a rank to the pool: what leaves most easily, each next to the one before if possible, or to
  /// the surplus of another rank, so that they can stay together elsewhere.
  void peel(Rank r, const std::vector<Index>& own, std::vector<Index>& pool) {
    // With those that leave, less that with those that stay.
    for (const Index i : own)
      for (const Neighbor& n : neighbors_of(i))
        border_[i] += staying(i, n, r) != kUnlisted ? -n.length : is_where_work_goes(i, n) ? n.length : 0;
    const auto key = [&](Index i) {
      const SubdomainLoad& s = snapshot_.subdomains[i];
      return std::tuple(-static_cast<std::int64_t>(weight_class(s)), border_[i], s.turn, s.remaining, -to_int(s.id));
    };
    using Entry = std::pair<decltype(key(0)), Index>;
    std::priority_queue<Entry> queue;
    for (const Index i : own) queue.emplace(key(i), i);
    while (load(r) > share(r) && !queue.empty()) {
      const auto [was, i] = queue.top();
      queue.pop();
      if (gone_[i] || was != key(i)) continue;
      gone_[i] = true;
      load(r) -= snapshot_.subdomains[i].remaining;
      pool.push_back(i);
      for (const Neighbor& n : neighbors_of(i))
        if (const Index j = staying(i, n, r); j != kUnlisted) {
          border_[j] += 2 * n.length;
          if (!snapshot_.subdomains[j].fixed) queue.emplace(key(j), j);
        }
    }
  }

  void give(Index i, Rank taker, RanksByFinish& takers) {
    if (taker != snapshot_.subdomains[i].owner)
      snapshot_.ranks[taker].free_memory -= memory_for(snapshot_.subdomains[i]);
    snapshot_.subdomains[i].owner = taker;
    load(taker) += snapshot_.subdomains[i].remaining;
    takers.set_load(taker, load(taker));
  }

  [[nodiscard]] bool has_memory(Rank r, const SubdomainLoad& s) const {
    return r == s.owner || memory_for(s) <= snapshot_.ranks[r].free_memory;
  }
  [[nodiscard]] bool has_room(Rank r, const SubdomainLoad& s) {
    return load(r) + s.remaining <= share(r) && has_memory(r, s);
  }

  /// To the rank with the longest border that has room for it, or to the one with most room.
  bool place_next_to_neighbors(Index i, RanksByFinish& takers) {
    const SubdomainLoad& s = snapshot_.subdomains[i];
    std::map<Rank, double> borders;
    for (const Neighbor& n : neighbors_of(i))
      if (const Index j = open(i, n); j != kUnlisted && has_room(snapshot_.subdomains[j].owner, s))
        borders[snapshot_.subdomains[j].owner] += n.length;
    const auto longest = std::ranges::max_element(borders, {}, [](const auto& b) { return b.second; });
    if (longest != borders.end()) {
      give(i, longest->first, takers);
      return true;
    }
    const Rank roomiest = takers.roomiest(limit_);
    if (!has_room(roomiest, s)) return false;
    give(i, roomiest, takers);
    return true;
  }

  // Ties go to the owner, so that nothing moves without a reason.
  void place_earliest(Index i, RanksByFinish& takers) {
    const SubdomainLoad& s = snapshot_.subdomains[i];
    give(i, takers.earliest(s.remaining, s.owner, [&](Rank r) { return has_memory(r, s); }), takers);
  }

  LoadSnapshot snapshot_;
  double tolerance_;
  double ideal_, limit_;  // seconds
  IdVector<Rank, double> speeds_;
  IdVector<SubdomainId, Index> index_;  // among those listed
  std::vector<double> border_;          // for each subdomain of a rank that gives some up
  std::vector<bool> gone_;              // given up
};

}  // namespace

LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance) {
  LoadSnapshot dealt = Dealer(snapshot, tolerance).deal_singly();
  const double earliest = finishing_time(dealt), ideal = ideal_time(snapshot);
  if (!snapshot.layout) return earliest < finishing_time(snapshot) ? dealt : snapshot;
  // Large pieces do not always fit; the more room, the likelier.
  for (const double room : {0.5, 1.0, 1.5}) {
    const double limit = earliest + room * tolerance * ideal;
    LoadSnapshot together = Dealer(snapshot, tolerance).deal_together(limit);
    if (finishing_time(together) > limit) continue;
    dealt = std::move(together);
    break;
  }
  return finishing_time(dealt) < finishing_time(snapshot) ? dealt : snapshot;
}

}  // namespace driftmesh::balancer
