#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "balancer/snapshot/rank_news.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// All ranks at one moment, as the broker shows them to a policy: made once for all requests of the moment, and then
/// kept up to date with the ranks that each of them concerns.
class RankBoard {
 public:
  RankBoard(const RankNews& news, std::shared_ptr<const Layout> layout, double now);

  void put(Rank rank, const RankLoad& state, bool able);

  /// Lists no subdomains.
  [[nodiscard]] const LoadSnapshot& snapshot() const { return snapshot_; }
  /// For each rank, whether it has something to give.
  [[nodiscard]] const IdVector<Rank, bool>& able() const { return able_; }
  /// Idle ranks per possible giver, not counting the one that asks.
  [[nodiscard]] std::uint32_t rivals() const;
  /// Seconds in which all ranks could do all work, if it were arbitrarily divisible.
  [[nodiscard]] double ideal_time() const { return work_ / speed_; }

 private:
  LoadSnapshot snapshot_;
  IdVector<Rank, bool> able_;
  std::size_t idle_ = 0, givers_ = 0;
  double work_ = 0, speed_ = 0;  // sums over all ranks
};

}  // namespace driftmesh::balancer
