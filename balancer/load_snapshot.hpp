#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "protocol/ids.hpp"

/// Who works on what: load, plans, and the policies that make them. Nothing here knows a transport or a clock; times
/// are in seconds, work is in triangles.
namespace driftmesh::balancer {

using protocol::Rank;
using protocol::SubdomainId;

/// The place of a rank in a list of all ranks.
[[nodiscard]] inline std::size_t index(Rank rank) {
  return static_cast<std::size_t>(rank);
}

/// A subdomain that another one shares a border with.
struct Neighbour {
  SubdomainId subdomain = 0;
  double length = 0;  ///< of the border
};

/// What all ranks know from the start, and what does not change during a run.
struct Layout {
  struct Subdomain {
    double x = 0, y = 0;   ///< centroid
    double predicted = 0;  ///< triangles that it will have
    Rank owner = 0;        ///< at the start
    std::vector<Neighbour> neighbours;
  };
  std::vector<Subdomain> subdomains;
  Rank ranks = 1;

  [[nodiscard]] const Subdomain& operator[](SubdomainId s) const { return subdomains[static_cast<std::size_t>(s)]; }
};

/// A subdomain that is not finished.
struct SubdomainState {
  SubdomainId id = 0;
  Rank owner = 0;
  double remaining = 0;     ///< triangles still to be made, predicted
  std::uint64_t bytes = 0;  ///< to move it
  std::int32_t turn =
      0;  ///< its place in the owner's order of work: 0 is being worked on, the last will be there longest
};

/// Its bytes in units of 64 KiB: below that, one is as easily moved as the other.
[[nodiscard]] inline std::uint64_t weight_class(const SubdomainState& s) {
  return s.bytes >> 16;
}

/// Whether `a` leaves its rank more easily than `b`: what is light, and of this what will be worked on last.
[[nodiscard]] bool leaves_before(const SubdomainState& a, const SubdomainState& b);

struct RankState {
  double speed = 0;      ///< triangles a second, measured; 0: not known
  double remaining = 0;  ///< of all its subdomains, also of those that the snapshot does not list
};

/// The load at one moment, as the one who plans knows it. A rank that plans for itself may know other ranks by their
/// sums alone, and not list their subdomains.
struct LoadSnapshot {
  std::shared_ptr<const Layout> layout;
  std::vector<SubdomainState> subdomains;  ///< in ascending order of their numbers, each once
  std::vector<RankState> ranks;            ///< of all ranks
};

struct Move {
  SubdomainId subdomain = 0;
  Rank destination = 0;
  friend bool operator==(const Move&, const Move&) = default;
};

/// Sets `remaining` of each rank to the sum over the subdomains listed as its own.
void sum_up(LoadSnapshot& snapshot);

/// The listed subdomain of that number, or null.
[[nodiscard]] const SubdomainState* find(const LoadSnapshot& snapshot, SubdomainId id);

/// The speed of each rank: where it is not known (or not a positive number), the mean of those that are; 1 if none is.
[[nodiscard]] std::vector<double> assumed_speeds(std::span<const RankState> ranks);

/// When the last rank will have finished if nothing moves: the maximum of remaining / speed.
[[nodiscard]] double finishing_time(const LoadSnapshot& snapshot);
/// When all would finish if work could be cut at will: total work / total speed.
[[nodiscard]] double ideal_time(const LoadSnapshot& snapshot);

/// The snapshot after `moves`, which are valid. What is moved more than once ends where the last move takes it.
[[nodiscard]] LoadSnapshot after(LoadSnapshot snapshot, std::span<const Move> moves);

/// The moves that lead from one snapshot to another of the same subdomains with other owners.
[[nodiscard]] std::vector<Move> moves_between(const LoadSnapshot& from, const LoadSnapshot& to);

}  // namespace driftmesh::balancer
