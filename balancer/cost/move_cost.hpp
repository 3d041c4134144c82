#pragma once

#include <span>
#include <vector>

#include "balancer/snapshot/deliberation.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The cost of a move for both ranks, in seconds of their time. Packing is processor work: a slow rank is slow at it
/// too.
struct MoveCost {
  double latency = 1e-3;     ///< seconds until the new owner can start
  double bandwidth = 1e9;    ///< bytes per second between two ranks
  double pack_work = 0.015;  ///< triangles that a rank could make in the time to pack or unpack one byte

  [[nodiscard]] double for_giver(std::uint64_t bytes, double speed) const {
    return static_cast<double>(bytes) * pack_work / speed;
  }
  [[nodiscard]] double for_taker(std::uint64_t bytes, double speed) const {
    return latency + static_cast<double>(bytes) / bandwidth + static_cast<double>(bytes) * pack_work / speed;
  }
};

/// Sets what a move of each listed subdomain costs, and fixes those that are finished before they would have moved.
void price_moves(LoadSnapshot& snapshot, const MoveCost& cost);

/// How much a plan must gain before anything moves.
struct Worth {
  double gain = defaults::kGain;  ///< fraction of the finishing time to save
  double seconds = 2e-3;          ///< time to save
  double slack = 0.01;            ///< fraction of the ideal time given away for fewer moves
};

/// How much later than on average the last rank would seem to finish, in seconds, if work were even and only forecasts
/// and speeds in doubt: the expected maximum of as many normal deviates as there are ranks with work.
[[nodiscard]] double noise_of(const LoadSnapshot& snapshot);

/// Counts no doubts once a rank has no work: whatever that is given saves time.
void be_sure_of_idle_ranks(LoadSnapshot& snapshot);

/// What is left of an apparent gain when there is noise: that contributed to it, and will again after the moves.
[[nodiscard]] double gain_beyond(double noise, double apparent);

/// How much earlier the last rank would finish if work were even, in seconds, beyond noise.
[[nodiscard]] double possible_gain(const LoadSnapshot& snapshot);

/// Whether a plan may be reduced to the moves that it needs.
enum class Kept { kNeeded, kAll };

/// The worthwhile moves of `moves`, in their order. With their costs they reduce the finishing time, beyond noise, by
/// at least what `worth` requires; otherwise the result is empty. Dropped are invalid moves (unknown subdomain or rank,
/// to the owner, a second move of a subdomain, a fixed one), moves of subdomains too large for one message, moves to
/// ranks without memory for them, moves that cost more than the work they move, and, with Kept::kNeeded, moves without
/// which the finishing time is no later, or within the slack of the ideal time; the ones with the highest cost for
/// their work go first.
[[nodiscard]] std::vector<Move> worth_moving(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                             const MoveCost& cost, const Worth& worth = {}, Kept kept = Kept::kNeeded);

/// The finishing time of each rank, including costs, if all of `moves` are made that are valid and cost less than the
/// work they move.
[[nodiscard]] IdVector<Rank, double> finishing_times(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                                     const MoveCost& cost);

}  // namespace driftmesh::balancer
