#include "balancer/planner/plan_choice.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "balancer/planner/mend_plan.hpp"
#include "balancer/planner/within_memory.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {

bool PlanChoice::affords_whole(const LoadSnapshot& snapshot, const Situation& situation) const {
  const double cost = cost_of_whole(snapshot, situation);
  if (situation.now < next_ || 8 * cost > ideal_time(snapshot)) return false;
  return possible_gain(within_memory(snapshot)) > std::max(cost, overruled_gain_);
}

double PlanChoice::cost_of_whole(const LoadSnapshot& snapshot, const Situation& situation) const {
  const double slower = situation.speed > 0 ? options_.reference_speed / situation.speed : 1;
  const double parts = policy_->planning_seconds(snapshot);
  const double mending = parts > 0 ? PlanningCosts{}.seconds(effort_of_mending(snapshot)) : 0;
  return std::max(cost_, slower * (parts + mending));
}

std::vector<Move> PlanChoice::choose(const LoadSnapshot& snapshot, const Situation& situation) {
  const auto needed = [&](const std::vector<Move>& moves) {
    return worth_moving(snapshot, moves, options_.cost, options_.worth);
  };
  const auto single = policy_->touch_up(snapshot);
  if (!single) return needed(policy_->plan(snapshot, kLeadingRank));
  std::vector<Move> few = needed(*single);
  if (few.empty() || !affords_whole(snapshot, situation)) return few;
  const std::vector<Move> plan = policy_->plan(snapshot, kLeadingRank);
  state_ = State::kAskedForWhole;
  asked_at_ = situation.now;
  return plan == *single ? few : better_of(plan, few, snapshot);
}

bool PlanChoice::took(double seconds) {
  if (std::exchange(state_, State::kSingly) == State::kSingly) return false;
  cost_ = std::max(cost_, seconds);
  next_ = asked_at_ + seconds / options_.overhead;
  return true;
}

/// A plan is made as a whole, since what makes it better than single moves would be lost in parts, or not at all: it is
/// mended, and must then end notably earlier than those, or as early with less border between ranks and not too many
/// moves. Otherwise the single moves are made, mended if that leaves less border.
std::vector<Move> PlanChoice::better_of(const std::vector<Move>& plan, const std::vector<Move>& few,
                                        const LoadSnapshot& snapshot) {
  const double ideal = ideal_time(within_memory(snapshot)), singly = finish(snapshot, few);
  const auto worthwhile = [&](std::span<const Move> moves, std::size_t most, Kept kept) {
    return worth_moving(snapshot, mended(moves, snapshot, ideal, singly, most), options_.cost, options_.worth, kept);
  };
  const auto border = [&](const std::vector<Move>& moves) { return border_between_ranks(after(snapshot, moves)); };
  const double border_singly = border(few);

  std::vector<Move> whole = worthwhile(plan, most_moves(few), Kept::kAll);
  const double later = finish(snapshot, whole) - singly, border_whole = border(whole);
  const bool is_earlier = later < -options_.worth.gain * ideal;
  const bool is_as_early = later <= options_.worth.slack * ideal && whole.size() <= most_moves(few);
  const bool takes_whole = is_earlier || (is_as_early && border_whole < border_singly);
  note_comparison(0, border_whole, takes_whole);
  note_comparison(1, border_singly, !takes_whole);
  overruled_gain_ = takes_whole ? 0 : possible_gain(within_memory(snapshot));
  if (takes_whole) return whole;

  std::vector<Move> few_mended = worthwhile(few, few.size(), Kept::kNeeded);
  const double border_mended = border(few_mended);
  const bool takes_mended = !few_mended.empty() && border_mended < border_singly;
  note_comparison(0, border_mended, takes_mended);
  note_comparison(2, border_singly, !takes_mended);
  return takes_mended ? few_mended : few;
}

/// Seconds until all have finished what they then have.
double PlanChoice::finish(const LoadSnapshot& snapshot, std::span<const Move> moves) const {
  return std::ranges::max(finishing_times(snapshot, moves, options_.cost));
}

/// The plan, so that it ends about as early as single moves do, with no more moves than it may have then. One that ends
/// notably earlier may have any number.
std::vector<Move> PlanChoice::mended(std::span<const Move> plan, const LoadSnapshot& snapshot, double ideal,
                                     double singly, std::size_t most_moves) const {
  const double slack = options_.worth.slack * ideal, as_made = finish(snapshot, plan);
  const bool is_better = as_made < singly - options_.worth.gain * ideal;
  const double latest = singly + (1 - 1e-9) * slack;  // sums are rounded
  return mend_plan(snapshot, plan, options_.cost,
                   {std::min(std::max(as_made, ideal + slack), latest), latest, is_better ? SIZE_MAX : most_moves});
}

std::size_t PlanChoice::most_moves(std::span<const Move> few) const {
  const double most = policy_->most_moves() * static_cast<double>(few.size());
  return most < 1e15 ? static_cast<std::size_t>(most) : SIZE_MAX;
}

}  // namespace driftmesh::balancer
