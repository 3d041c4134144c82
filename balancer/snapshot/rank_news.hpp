#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "balancer/snapshot/messages.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Rank 0's knowledge of the total load of each rank: initially what the layout predicts.
class RankNews {
 public:
  /// At `now` the run begins.
  RankNews(const Layout& layout, double now);

  /// Handles news that arrived at `now`; ignored if newer ones are known. Returns whether that rank has something to
  /// give, and more work than assumed.
  bool hear(Rank rank, const LoadNews& news, double now);
  /// A rank asked for work, and said how much memory it has free. Only of use until its first news, which may come
  /// later.
  void hear_memory(Rank rank, double free_memory);
  /// This much work will move from one rank to another, which they have not reported yet.
  void expect(Rank from, Rank to, double work, double now);

  /// Whether all ranks have reported.
  [[nodiscard]] bool complete() const { return reported_ == ranks_.size(); }

  /// All ranks at `now`: the last news minus what they must have done since.
  [[nodiscard]] IdVector<Rank, RankLoad> states(double now) const;
  [[nodiscard]] RankLoad state(Rank rank, double now) const;
  /// Whether a rank in that state has something to give. It works on that last.
  [[nodiscard]] bool can_give(Rank rank, const RankLoad& state) const;
  /// The speed, or if it is not known, the mean of those that are.
  [[nodiscard]] double known_or_mean(double speed) const;

 private:
  struct Heard {
    LoadNews news;
    double at = 0;
  };
  void set_speed(Rank rank, double speed);

  IdVector<Rank, Heard> ranks_;
  std::size_t reported_ = 0;
  double sum_ = 0;  // all known speeds together
  int known_ = 0;
};

}  // namespace driftmesh::balancer
