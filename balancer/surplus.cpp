#include "balancer/surplus.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "balancer/effort.hpp"

namespace driftmesh::balancer {
namespace {

using Index = std::size_t;  // into the listed subdomains

/// The listed subdomain with this ID, or none.
std::optional<Index> index_of(const LoadSnapshot& snapshot, SubdomainId id) {
  const SubdomainLoad* const s = find(snapshot, id);
  return s ? std::optional<Index>(s - snapshot.subdomains.data()) : std::nullopt;
}

std::vector<Neighbor> neighbors_of(const LoadSnapshot& snapshot, const SubdomainLoad& s) {
  return snapshot.layout ? (*snapshot.layout)[s.id].neighbors : std::vector<Neighbor>();
}

class Dealer {
 public:
  Dealer(const LoadSnapshot& snapshot, double tolerance)
      : snapshot_(snapshot),
        tolerance_(tolerance),
        ideal_(ideal_time(snapshot)),
        speeds_(assumed_speeds(snapshot.ranks)) {}

  /// Subdomains that are neighbors stay together where ranks have room for them.
  LoadSnapshot deal_together() {
    std::vector<Index> left;
    const std::vector<Index> pool = collect();
    note_place(pool);
    for (const Index i : pool)
      if (!place_within_shares(i)) left.push_back(i);
    return deal_singly(std::move(left));
  }
  /// Largest first, each to the rank that would finish it first.
  LoadSnapshot deal_singly() { return deal_singly(collect()); }

 private:
  LoadSnapshot deal_singly(std::vector<Index> pool) {
    note_place(pool);
    std::ranges::sort(pool, {}, [&](Index i) {
      const SubdomainLoad& s = snapshot_.subdomains[i];
      return std::tuple(-s.remaining, s.id);
    });
    for (const Index i : pool) place_earliest(i);
    return std::move(snapshot_);
  }

  void note_place(const std::vector<Index>& pool) const {
    note_effort("place", static_cast<double>(pool.size() * speeds_.size()));
  }

  double& load(Rank rank) { return snapshot_.ranks[rank].remaining; }
  [[nodiscard]] double share(Rank rank) const { return ideal_ * speeds_[rank]; }

  /// The surplus of all ranks.
  std::vector<Index> collect() {
    note_effort("deal", static_cast<double>(snapshot_.subdomains.size()));
    IdVector<Rank, std::vector<Index>> own(snapshot_.ranks.size());
    for (Index i = 0; i < snapshot_.subdomains.size(); ++i)
      if (!snapshot_.subdomains[i].fixed) own[snapshot_.subdomains[i].owner].push_back(i);
    std::vector<Index> pool;
    for (const Rank r : ids_of(own))
      if (load(r) > share(r) * (1 + tolerance_)) peel(r, own[r], pool);
    return pool;
  }

  /// Adds the surplus of a rank to the pool: what leaves most easily, each next to the one before if possible, so that
  /// they can stay together elsewhere.
  void peel(Rank r, const std::vector<Index>& own, std::vector<Index>& pool) {
    std::map<Index, double> border;  // with those that leave, less that with those that stay
    for (const Index i : own)
      for (const Neighbor& n : neighbors_of(snapshot_, snapshot_.subdomains[i]))
        if (const auto j = index_of(snapshot_, n.subdomain); j && snapshot_.subdomains[*j].owner == r)
          border[i] -= n.length;
    const auto key = [&](Index i) {
      const SubdomainLoad& s = snapshot_.subdomains[i];
      return std::tuple(-static_cast<std::int64_t>(weight_class(s)), border[i], s.turn, s.remaining, -to_int(s.id));
    };
    using Entry = std::pair<decltype(key(0)), Index>;
    std::priority_queue<Entry> queue;
    for (const Index i : own) queue.emplace(key(i), i);
    std::vector<bool> gone(snapshot_.subdomains.size(), false);
    while (load(r) > share(r) && !queue.empty()) {
      const auto [was, i] = queue.top();
      queue.pop();
      if (gone[i] || was != key(i)) continue;
      gone[i] = true;
      const SubdomainLoad& s = snapshot_.subdomains[i];
      load(r) -= s.remaining;
      pool.push_back(i);
      for (const Neighbor& n : neighbors_of(snapshot_, s))
        if (const auto j = index_of(snapshot_, n.subdomain); j && snapshot_.subdomains[*j].owner == r && !gone[*j]) {
          border[*j] += 2 * n.length;
          queue.emplace(key(*j), *j);
        }
    }
  }

  void give(Index i, Rank taker) {
    if (taker != snapshot_.subdomains[i].owner)
      snapshot_.ranks[taker].free_memory -= memory_for(snapshot_.subdomains[i]);
    snapshot_.subdomains[i].owner = taker;
    load(taker) += snapshot_.subdomains[i].remaining;
  }

  [[nodiscard]] bool has_memory(Rank r, const SubdomainLoad& s) const {
    return r == s.owner || memory_for(s) <= snapshot_.ranks[r].free_memory;
  }
  [[nodiscard]] bool has_room(Rank r, const SubdomainLoad& s) {
    return load(r) + s.remaining <= share(r) && has_memory(r, s);
  }

  /// To the rank with the longest border that has room for it in its share, or to the one with most room.
  bool place_within_shares(Index i) {
    const SubdomainLoad& s = snapshot_.subdomains[i];
    std::map<Rank, double> borders;
    for (const Neighbor& n : neighbors_of(snapshot_, s))
      if (const Rank r = owner_of(snapshot_, n.subdomain); has_room(r, s)) borders[r] += n.length;
    const auto longest = std::ranges::max_element(borders, {}, [](const auto& b) { return b.second; });
    if (longest != borders.end()) {
      give(i, longest->first);
      return true;
    }
    const Rank roomiest = std::ranges::max(ids_of(speeds_), {}, [&](Rank r) { return share(r) - load(r); });
    if (!has_room(roomiest, s)) return false;
    give(i, roomiest);
    return true;
  }

  // Ties go to the owner, so that nothing moves without a reason.
  void place_earliest(Index i) {
    const SubdomainLoad& s = snapshot_.subdomains[i];
    Rank best = s.owner;
    double earliest = (load(best) + s.remaining) / speeds_[best];
    for (const Rank r : ids_of(speeds_)) {
      const double finished = (load(r) + s.remaining) / speeds_[r];
      if (finished < earliest && has_memory(r, s)) best = r, earliest = finished;
    }
    give(i, best);
  }

  LoadSnapshot snapshot_;
  double tolerance_;
  double ideal_;
  IdVector<Rank, double> speeds_;
};

}  // namespace

LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance) {
  LoadSnapshot together = Dealer(snapshot, tolerance).deal_together();
  LoadSnapshot singly = Dealer(snapshot, tolerance).deal_singly();
  const double latest = finishing_time(singly) + tolerance / 2 * ideal_time(snapshot);
  LoadSnapshot dealt = std::move(finishing_time(together) <= latest ? together : singly);
  if (finishing_time(dealt) < finishing_time(snapshot)) return dealt;
  return snapshot;
}

}  // namespace driftmesh::balancer
