#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driftmesh/ids.hpp"

/// Load balancing: load, plans, and the policies that make them. Nothing here knows a transport or a clock; times are
/// in seconds, work is in triangles.
namespace driftmesh::balancer {

/// A subdomain that shares a border with another one.
struct Neighbor {
  SubdomainId subdomain{};
  double length = 0;  ///< length of the border
};

/// What all ranks know from the start and what does not change during a run.
struct Layout {
  struct Subdomain {
    double x = 0, y = 0;   ///< centroid
    double predicted = 0;  ///< triangles that it will have, with as many more as its start is worth
    Rank owner{};          ///< at the start
    std::vector<Neighbor> neighbors;
    bool on_segments = false;  ///< segments of the input bound it, or are in it
  };
  IdVector<SubdomainId, Subdomain> subdomains;
  std::int32_t ranks = 1;

  [[nodiscard]] const Subdomain& operator[](SubdomainId s) const { return subdomains[s]; }
};

/// A subdomain that is not finished.
struct SubdomainLoad {
  SubdomainId id{};
  Rank owner{};
  double remaining = 0;     ///< triangles still to be made, predicted
  std::uint64_t bytes = 0;  ///< bytes that moving it sends
  std::int32_t turn = 0;    ///< position in the owner's order of work; 0 is being worked on
  double cost = 0;          ///< seconds of both ranks that moving it takes, at mean speed
  bool fixed = false;       ///< it may not move now: it is on its way, has just moved, or costs more than it has left
};

/// Its size in units of 64 KiB: smaller differences do not affect the cost of a move.
[[nodiscard]] inline std::uint64_t weight_class(const SubdomainLoad& s) {
  return s.bytes >> 16;
}

/// The triangles for which a rank that takes it needs memory: those that it has and will have.
[[nodiscard]] double memory_for(const SubdomainLoad& s);

/// Whether `a` should leave its rank before `b`: lighter ones first, then those whose turn comes last.
[[nodiscard]] bool leaves_before(const SubdomainLoad& a, const SubdomainLoad& b);

/// More triangles than any rank has memory for, and no less when some are taken off: it is not known to be short of it.
inline constexpr double kAmpleMemory = 1e300;

struct RankLoad {
  double speed = 0;                   ///< triangles a second, measured; 0: not known
  double remaining = 0;               ///< sum over all its subdomains, including those that the snapshot does not list
  double doubt = 0;                   ///< standard deviation of the time for this, over that time
  double free_memory = kAmpleMemory;  ///< triangles that it has memory for besides those that it has and will make
};

/// One of as many parts as there are ranks. Part p is sized for the speed of rank p, but may be assigned to another
/// rank.
enum class Part : std::int32_t {};

/// The load at one moment, as known to the planner. A rank that plans for itself may know only the totals of other
/// ranks, and not list their subdomains.
///
/// \code
/// driftmesh::balancer::LoadSnapshot load;
/// load.ranks.push_back({.speed = 2e6, .remaining = 8e6});
/// load.ranks.push_back({.speed = 1e6, .remaining = 1e6});
/// assert(finishing_time(load) == 4 && ideal_time(load) == 3);
/// \endcode
struct LoadSnapshot {
  std::shared_ptr<const Layout> layout;
  std::vector<SubdomainLoad> subdomains;  ///< in ascending order of IDs, each once
  IdVector<Rank, RankLoad> ranks;         ///< all ranks
};

struct Move {
  SubdomainId subdomain{};
  Rank destination{};
  friend bool operator==(const Move&, const Move&) = default;
};

/// For each listed subdomain, the part that belongs to its owner.
[[nodiscard]] std::vector<Part> present_parts(const LoadSnapshot& snapshot);

/// Sets `remaining` of each rank to the sum over its listed subdomains.
void sum_up(LoadSnapshot& snapshot);

/// The listed subdomain with this ID, or null.
[[nodiscard]] const SubdomainLoad* find(const LoadSnapshot& snapshot, SubdomainId id);

/// Whether a speed is known: above 0, and finite.
[[nodiscard]] inline bool is_speed(double speed) {
  return speed > 0 && std::isfinite(speed);
}
/// The mean of the speeds that are known, or 1.
[[nodiscard]] double mean_speed(IdSpan<Rank, const RankLoad> ranks);

/// The speed of each rank. Unknown or nonpositive speeds are replaced by the mean of the others, or by 1 if all are.
[[nodiscard]] IdVector<Rank, double> assumed_speeds(IdSpan<Rank, const RankLoad> ranks);

/// When the last rank finishes if nothing moves: the maximum of remaining / speed.
[[nodiscard]] double finishing_time(const LoadSnapshot& snapshot);
/// When all would finish if work were arbitrarily divisible: total work / total speed.
[[nodiscard]] double ideal_time(const LoadSnapshot& snapshot);

/// Whether most of the points on the border between two neighbors are still to be made: neither has most of its work
/// behind it. Else both know them already, and it does not matter which ranks have the two.
[[nodiscard]] bool is_open_border(const LoadSnapshot& snapshot, const SubdomainLoad& a, const SubdomainLoad& b);
/// The length of the open borders between subdomains of different ranks.
[[nodiscard]] double border_between_ranks(const LoadSnapshot& snapshot);

/// The snapshot after `moves`, which must be valid. If a subdomain is moved more than once, its last move counts.
[[nodiscard]] LoadSnapshot after(LoadSnapshot snapshot, std::span<const Move> moves);

/// Its owner by the snapshot; of a subdomain that is not listed, the initial one.
[[nodiscard]] Rank owner_of(const LoadSnapshot& snapshot, SubdomainId id);

/// The moves that lead from one snapshot to another of the same subdomains with other owners.
[[nodiscard]] std::vector<Move> moves_between(const LoadSnapshot& from, const LoadSnapshot& to);

}  // namespace driftmesh::balancer
