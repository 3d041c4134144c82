#pragma once

#include <cstdint>
#include <vector>

#include "balancer/joint_plan.hpp"

namespace driftmesh::balancer {

/// Where all ranks plan together (Placement::kCollective). Real ranks meet in Zoltan, on their communicator; simulated
/// ones through an object that they share.
class Council {
 public:
  /// For one rank.
  struct Decision {
    std::vector<Move> moves;          ///< that it is to make
    IdVector<Rank, RankLoad> states;  ///< of all ranks, when all moves of all have been made
    JointPlan::Coming coming;         ///< to this rank
    bool any_moves = false;           ///< of any rank
  };

  virtual ~Council() = default;
  Council(const Council&) = delete;
  Council& operator=(const Council&) = delete;

  /// A rank is ready for a round, and has this to do at the moment; told again, what it has to do has changed.
  virtual void announce(std::uint32_t round, const Contribution& contribution) = 0;

  /// Called by each rank once in a round, when all have announced themselves. May wait for all of them to call it.
  [[nodiscard]] virtual Decision decide(std::uint32_t round, const Contribution& contribution) = 0;

 protected:
  Council() = default;
};

}  // namespace driftmesh::balancer
