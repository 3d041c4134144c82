#pragma once

#include <cstdint>
#include <vector>

#include "balancer/joint_plan.hpp"

namespace driftmesh::balancer {

/// The place where all ranks plan together (Placement::kCollective): for real ranks Zoltan on their communicator, for
/// simulated ranks a shared object.
class Council {
 public:
  /// For one rank.
  struct Decision {
    std::vector<Move> moves;          ///< that the rank is to make
    IdVector<Rank, RankLoad> states;  ///< of all ranks after all moves
    JointPlan::Coming coming;         ///< to this rank
    bool any_moves = false;           ///< of any rank
  };

  virtual ~Council() = default;
  Council(const Council&) = delete;
  Council& operator=(const Council&) = delete;

  /// A rank is ready for a round, with its current load. A second call updates the load.
  virtual void announce(std::uint32_t round, const Contribution& contribution) = 0;

  /// Called by each rank once per round, after all have announced themselves. May wait for all of them.
  [[nodiscard]] virtual Decision decide(std::uint32_t round, const Contribution& contribution) = 0;

 protected:
  Council() = default;
};

}  // namespace driftmesh::balancer
