#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "balancer/messages.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// What rank 0 has heard of the load of all ranks, each as a whole: at first what the layout predicts.
class RankNews {
 public:
  /// At `now` the run begins.
  RankNews(const Layout& layout, double now);

  /// News that came at `now`; ignored if later ones have come before. Whether that rank has something to give, and
  /// more to do than was believed.
  bool hear(Rank rank, const LoadNews& news, double now);
  /// This much work will go from one rank to another, and they have not said so yet.
  void expect(Rank from, Rank to, double work, double now);

  /// This is what all ranks have to do at `now`, whatever they said before.
  void assume(const IdVector<Rank, RankLoad>& states, double now);
  /// Whether all ranks have said something.
  [[nodiscard]] bool complete() const;

  /// All ranks at `now`: what was heard, less what they must have done since.
  [[nodiscard]] IdVector<Rank, RankLoad> states(double now) const;
  /// Of each rank, whether it has something to give. It works on that last.
  [[nodiscard]] IdVector<Rank, bool> able(const IdVector<Rank, RankLoad>& states) const;

 private:
  struct Heard {
    LoadNews news;
    double at = 0;
  };
  IdVector<Rank, Heard> ranks_;
};

}  // namespace driftmesh::balancer
