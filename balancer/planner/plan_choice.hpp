#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "balancer/snapshot/situation.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// The leader's choice between a whole plan of its policy and single moves. Whole plans have a pace of their own, since
/// single moves are had for less.
class PlanChoice {
 public:
  PlanChoice(std::shared_ptr<const Policy> policy, const ControllerOptions& options)
      : policy_(std::move(policy)), options_(options) {}

  /// Whether a whole plan may be asked for now. Not if an even load would gain less than planning takes, or less than
  /// when single moves were preferred to the last whole plan: what was no use with more to gain will be none with less.
  /// Nor if it takes more than an eighth of the time that is left: it would have to be begun so early (see time_ahead)
  /// that forecasts were of no use.
  [[nodiscard]] bool affords_whole(const LoadSnapshot& snapshot, const Situation& situation) const;
  /// What a whole plan takes, in seconds, mended: what one has taken, if that is more than expected.
  [[nodiscard]] double cost_of_whole(const LoadSnapshot& snapshot, const Situation& situation) const;

  /// The plan of the policy as far as it is worth its moves. If the policy offers single moves as well, a plan is asked
  /// for only where some of those are worth making: where none is, what remains is too coarse for parts as well, or no
  /// rank has memory.
  [[nodiscard]] std::vector<Move> choose(const LoadSnapshot& snapshot, const Situation& situation);

  /// The duration of the last choice. Whether it was that of a whole plan, and counts for the pace of those alone.
  [[nodiscard]] bool took(double seconds);

 private:
  enum class State {
    kSingly,         ///< the last choice was among single moves
    kAskedForWhole,  ///< the policy made a whole plan at the last choice; its duration is not known yet
  };

  [[nodiscard]] std::vector<Move> better_of(const std::vector<Move>& plan, const std::vector<Move>& few,
                                            const LoadSnapshot& snapshot);
  [[nodiscard]] double finish(const LoadSnapshot& snapshot, std::span<const Move> moves) const;
  [[nodiscard]] std::vector<Move> mended(std::span<const Move> plan, const LoadSnapshot& snapshot, double ideal,
                                         double singly, std::size_t most_moves) const;
  [[nodiscard]] std::size_t most_moves(std::span<const Move> few) const;

  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;
  State state_ = State::kSingly;
  double asked_at_ = 0, next_ = 0;  // times of whole plans
  double cost_ = 0;                 // seconds that the longest of them took
  double overruled_gain_ = 0;       // seconds that were to be gained when the last one was not kept
};

}  // namespace driftmesh::balancer
