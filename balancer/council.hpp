#pragma once

#include <cstdint>
#include <optional>
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

  /// Called by each rank in each round. Real ranks wait here for all others. A simulated one gets nothing at first: it
  /// must wait until all have called (protocol::StepResult::kAssembling), and then call again.
  [[nodiscard]] virtual std::optional<Decision> decide(std::uint32_t round, const Contribution& contribution) = 0;

 protected:
  Council() = default;
};

}  // namespace driftmesh::balancer
