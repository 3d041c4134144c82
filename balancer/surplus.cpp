#include "balancer/surplus.hpp"

#include <algorithm>
#include <tuple>

namespace driftmesh::balancer {
namespace {

using Indices = std::vector<std::size_t>;

/// For each rank, the indices of its subdomains, those first that leave most easily.
IdVector<Rank, Indices> by_owner(const LoadSnapshot& snapshot) {
  IdVector<Rank, Indices> lists(snapshot.ranks.size());
  for (std::size_t i = 0; i < snapshot.subdomains.size(); ++i) lists[snapshot.subdomains[i].owner].push_back(i);
  for (Indices& list : lists)
    std::sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) {
      return leaves_before(snapshot.subdomains[a], snapshot.subdomains[b]);
    });
  return lists;
}

class Dealer {
 public:
  Dealer(const LoadSnapshot& snapshot, double tolerance)
      : snapshot_(snapshot),
        tolerance_(tolerance),
        ideal_(ideal_time(snapshot)),
        speeds_(assumed_speeds(snapshot.ranks)) {}

  LoadSnapshot deal() {
    Indices pool = collect();
    std::sort(pool.begin(), pool.end(), [&](std::size_t a, std::size_t b) {
      const auto& one = snapshot_.subdomains[a];
      const auto& other = snapshot_.subdomains[b];
      return std::tuple(-one.remaining, one.id) < std::tuple(-other.remaining, other.id);
    });
    for (const std::size_t i : pool) place(i);
    return std::move(snapshot_);
  }

 private:
  double& load(Rank rank) { return snapshot_.ranks[rank].remaining; }

  Indices collect() {
    Indices pool;
    const IdVector<Rank, Indices> lists = by_owner(snapshot_);
    for (const Rank r : ids_of(lists)) {
      const double share = ideal_ * speeds_[r];
      if (load(r) <= share * (1 + tolerance_)) continue;
      for (const std::size_t i : lists[r]) {
        if (load(r) <= share) break;
        load(r) -= snapshot_.subdomains[i].remaining;
        pool.push_back(i);
      }
    }
    return pool;
  }

  // Ties go to the owner, so that nothing moves without a reason.
  void place(std::size_t i) {
    SubdomainLoad& s = snapshot_.subdomains[i];
    Rank best = s.owner;
    double earliest = (load(best) + s.remaining) / speeds_[best];
    for (const Rank r : ids_of(speeds_)) {
      const double finished = (load(r) + s.remaining) / speeds_[r];
      if (finished < earliest) best = r, earliest = finished;
    }
    s.owner = best;
    load(best) += s.remaining;
  }

  LoadSnapshot snapshot_;
  double tolerance_;
  double ideal_;
  IdVector<Rank, double> speeds_;
};

}  // namespace

LoadSnapshot deal_surplus(const LoadSnapshot& snapshot, double tolerance) {
  LoadSnapshot dealt = Dealer(snapshot, tolerance).deal();
  return finishing_time(dealt) < finishing_time(snapshot) ? dealt : snapshot;
}

}  // namespace driftmesh::balancer
