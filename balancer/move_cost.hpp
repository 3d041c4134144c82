#pragma once

#include <span>
#include <vector>

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// What moving a subdomain costs the two ranks, in seconds of their time. Packing is work of the processor: a slow
/// rank, of so many triangles a second, is slow at it too.
struct MoveCost {
  double latency = 1e-3;     ///< of any move, until the new owner can begin
  double bandwidth = 1e9;    ///< bytes a second between two ranks
  double pack_work = 0.015;  ///< triangles that a rank could make while it packs or unpacks a byte

  [[nodiscard]] double for_giver(std::uint64_t bytes, double speed) const {
    return static_cast<double>(bytes) * pack_work / speed;
  }
  [[nodiscard]] double for_taker(std::uint64_t bytes, double speed) const {
    return latency + static_cast<double>(bytes) / bandwidth + static_cast<double>(bytes) * pack_work / speed;
  }
};

/// How much better a plan must be before anything moves.
struct Worth {
  double gain = 0.02;     ///< of the finishing time, saved
  double seconds = 2e-3;  ///< saved
  double slack = 0.01;    ///< of the ideal time, given away for fewer moves
};

/// Whether a plan is worth being made at all: there is more to gain than the least worthwhile one must, and than making
/// it takes, in seconds.
[[nodiscard]] bool may_gain(const LoadSnapshot& snapshot, const Worth& worth, double cost_of_planning);

/// Those of `moves` that are worth making, in their order. The finishing time with their costs is below the present one
/// by what `worth` asks for; otherwise none is left. Left out are moves that are not valid (unknown subdomain or rank,
/// to the owner, a second one of a subdomain), of subdomains too large for one message, that cost more than the work
/// they move, and those without which the finishing time is no later, or within the slack of the ideal one: the ones
/// that cost most for their work first.
[[nodiscard]] std::vector<Move> worth_moving(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                             const MoveCost& cost, const Worth& worth = {});

/// When each rank will have finished if all of `moves` are made that are valid and cost less than they move, with what
/// they cost.
[[nodiscard]] IdVector<Rank, double> finishing_times(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                                     const MoveCost& cost);

/// The same moves, all of `giver`, less those that it can keep and still be through at most so many seconds later,
/// dearest first.
[[nodiscard]] std::vector<Move> needed_moves(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                             const MoveCost& cost, Rank giver, double spare);

}  // namespace driftmesh::balancer
