#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driftmesh/ids.hpp"

/// Who works on what: load, plans, and the policies that make them. Nothing here knows a transport or a clock; times
/// are in seconds, work is in triangles.
namespace driftmesh::balancer {

/// A subdomain that another one shares a border with.
struct Neighbor {
  SubdomainId subdomain{};
  double length = 0;  ///< of the border
};

/// What all ranks know from the start, and what does not change during a run.
struct Layout {
  struct Subdomain {
    double x = 0, y = 0;   ///< centroid
    double predicted = 0;  ///< triangles that it will have
    Rank owner{};          ///< at the start
    std::vector<Neighbor> neighbors;
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
  std::uint64_t bytes = 0;  ///< to move it
  std::int32_t turn =
      0;  ///< its place in the owner's order of work: 0 is being worked on, the last will be there longest
};

/// Its bytes in units of 64 KiB: below that, one is as easily moved as the other.
[[nodiscard]] inline std::uint64_t weight_class(const SubdomainLoad& s) {
  return s.bytes >> 16;
}

/// Whether `a` leaves its rank more easily than `b`: what is light, and of this what will be worked on last.
[[nodiscard]] bool leaves_before(const SubdomainLoad& a, const SubdomainLoad& b);

struct RankLoad {
  double speed = 0;      ///< triangles a second, measured; 0: not known
  double remaining = 0;  ///< of all its subdomains, also of those that the snapshot does not list
};

/// One of as many parts as there are ranks. Part p is made for rank p, as large as that is fast, and may end up on
/// another one.
enum class Part : std::int32_t {};

/// The load at one moment, as the one who plans knows it. A rank that plans for itself may know other ranks by their
/// sums alone, and not list their subdomains.
struct LoadSnapshot {
  std::shared_ptr<const Layout> layout;
  std::vector<SubdomainLoad> subdomains;  ///< in ascending order of their numbers, each once
  IdVector<Rank, RankLoad> ranks;         ///< of all ranks
};

struct Move {
  SubdomainId subdomain{};
  Rank destination{};
  friend bool operator==(const Move&, const Move&) = default;
};

/// Of each listed subdomain, the part that was made for its owner.
[[nodiscard]] std::vector<Part> present_parts(const LoadSnapshot& snapshot);

/// Sets `remaining` of each rank to the sum over the subdomains listed as its own.
void sum_up(LoadSnapshot& snapshot);

/// The listed subdomain of that number, or null.
[[nodiscard]] const SubdomainLoad* find(const LoadSnapshot& snapshot, SubdomainId id);

/// The speed of each rank: where it is not known (or not a positive number), the mean of those that are; 1 if none is.
[[nodiscard]] IdVector<Rank, double> assumed_speeds(IdSpan<Rank, const RankLoad> ranks);

/// When the last rank will have finished if nothing moves: the maximum of remaining / speed.
[[nodiscard]] double finishing_time(const LoadSnapshot& snapshot);
/// When all would finish if work could be cut at will: total work / total speed.
[[nodiscard]] double ideal_time(const LoadSnapshot& snapshot);

/// The snapshot after `moves`, which are valid. What is moved more than once ends where the last move takes it.
[[nodiscard]] LoadSnapshot after(LoadSnapshot snapshot, std::span<const Move> moves);

/// The moves that lead from one snapshot to another of the same subdomains with other owners.
[[nodiscard]] std::vector<Move> moves_between(const LoadSnapshot& from, const LoadSnapshot& to);

}  // namespace driftmesh::balancer
