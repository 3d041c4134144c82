#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "balancer/cost/move_cost.hpp"
#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {

/// What a mended plan must keep to.
struct MendingLimits {
  double finish = 0;      ///< seconds until all finish, so that what is needless can be left out and border saved
  double latest = 0;      ///< at least `finish`: later ranks are relieved; the same, where there are too many moves
  std::size_t moves = 0;  ///< this many may remain
};

/// A plan, mended so that it ends by `latest` and has no more moves than it may, as far as
/// that is possible, with little border between ranks:
/// 1. Ranks that would finish later give subdomains to others, or exchange some with them: whatever costs least border
///    for the time that it saves.
/// 2. Subdomains return to the ranks that have them: those whose return leaves no more border, and while there are too
///    many moves, those that cost least border for each move that is saved. What returns may take the place of another
///    newcomer, which goes where the first was, so that chains and cycles of moves become short.
/// 3. Subdomains go to adjacent ranks, alone or in exchange, where that makes the border shorter in the end. For each
///    further move it must save more than half of a mean border between two subdomains.
/// No rank gets what it has no memory for beyond what `moves` give it. What cannot move is left out; `cost` counts for
/// both ranks of each move.
[[nodiscard]] std::vector<Move> mend_plan(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                          const MoveCost& cost, const MendingLimits& limits);

/// What that takes, roughly: 220 to 340 changes are considered for each subdomain, and twice as many where many ranks
/// are late.
[[nodiscard]] Efforts effort_of_mending(const LoadSnapshot& snapshot);

}  // namespace driftmesh::balancer
