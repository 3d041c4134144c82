#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "balancer/cost/move_cost.hpp"

namespace driftmesh::balancer {

/// A plan that is being changed, and what changes of it would mean. Subdomains are numbered as the snapshot lists them.
class Draft {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = UINT32_MAX;

  struct Border {
    Index beyond = kNone;
    double length = 0;
  };

  /// A subdomain goes to another rank, and one from there may take its place.
  struct Change {
    Index goes = kNone;
    Rank to{};
    Index comes = kNone;
    double border = 0;  ///< more between ranks
    int saved = 0;      ///< moves

    [[nodiscard]] double border_for_a_move() const { return border / saved; }
  };

  /// Begins with the moves that are possible: of listed subdomains that are not fixed. Both ranks spend time on each,
  /// as `cost` says.
  Draft(const LoadSnapshot& before, std::span<const Move> moves, const MoveCost& cost);

  void make(const Change& change);
  [[nodiscard]] std::vector<Move> list() const;

  [[nodiscard]] Index size() const { return static_cast<Index>(owners_.size()); }
  [[nodiscard]] std::size_t moves() const { return moves_; }
  [[nodiscard]] const SubdomainLoad& load(Index i) const { return before_.subdomains[i]; }
  [[nodiscard]] Rank home(Index i) const { return load(i).owner; }
  [[nodiscard]] Rank owner(Index i) const { return owners_[i]; }
  [[nodiscard]] bool has_moved(Index i) const { return owner(i) != home(i); }
  /// Open borders with listed subdomains.
  [[nodiscard]] std::span<const Border> borders(Index i) const {
    return std::span(borders_).subspan(first_border_[i], first_border_[i + 1] - first_border_[i]);
  }
  [[nodiscard]] double mean_border() const;
  /// Other ranks that it has borders with, each once.
  [[nodiscard]] std::vector<Rank> ranks_around(Index i) const;

  /// When each rank finishes, in seconds.
  [[nodiscard]] const IdVector<Rank, double>& times() const { return times_; }
  /// What a rank has that may move.
  [[nodiscard]] const std::vector<Index>& held_by(Rank r) const { return held_[r]; }
  /// Counts the changes so far, and up to the last one of a rank.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  [[nodiscard]] std::uint64_t last_change(Rank r) const { return last_change_[r]; }

  /// What a subdomain takes of the time of a rank: at home less what it takes to give it away.
  [[nodiscard]] double seconds(Index i, Rank r) const {
    const Effort& e = efforts_[i];
    return r == home(i) ? (e.work - e.packing) * slowness_[r] : (e.work + e.packing) * slowness_[r] + e.transfer;
  }
  /// Whether `i` fits there, and `j`, unless it is kNone, fits where `i` was.
  [[nodiscard]] bool has_memory(Index i, Rank to, Index j) const { return fits(i, to, j) && fits(j, owner(i), i); }
  /// When its rank and the other one finish if `i` goes there, and `j`, unless it is kNone, comes.
  [[nodiscard]] std::pair<double, double> times_after(Index i, Rank to, Index j) const {
    ++considered_;
    const Rank from = owner(i);
    const double here = times_[from] - seconds(i, from), there = times_[to] + seconds(i, to);
    return j == kNone ? std::pair(here, there) : std::pair(here + seconds(j, from), there - seconds(j, to));
  }
  /// What it means for `i` to go to another rank.
  [[nodiscard]] Change change(Index i, Rank to) const { return {i, to, kNone, more_border(i, to), moves_saved(i, to)}; }
  /// The same, and `j`, unless it is kNone, comes.
  [[nodiscard]] Change in_exchange(Change change, Index j) const;
  /// Number of changes that times_after() has been asked about so far.
  [[nodiscard]] std::uint64_t considered() const { return considered_; }

 private:
  /// What a subdomain costs.
  struct Effort {
    double work = 0;      // triangles
    double packing = 0;   // triangles that a rank could make meanwhile
    double transfer = 0;  // seconds
  };

  [[nodiscard]] bool fits(Index i, Rank to, Index leaves) const;
  [[nodiscard]] int moves_saved(Index i, Rank to) const { return (has_moved(i) ? 1 : 0) - (to != home(i) ? 1 : 0); }
  [[nodiscard]] double more_border(Index i, Rank to) const;
  void add_borders();
  void put(Index i, Rank to);

  const LoadSnapshot& before_;
  IdVector<Rank, double> slowness_;  // seconds for a triangle
  std::vector<Effort> efforts_;
  std::vector<Rank> owners_;
  std::vector<Border> borders_;  // the first subdomain's, the second's, ...
  std::vector<std::size_t> first_border_;
  IdVector<Rank, double> times_, free_memory_;
  IdVector<Rank, std::vector<Index>> held_;
  IdVector<Rank, std::uint64_t> last_change_;
  std::uint64_t changes_ = 0;
  std::size_t moves_ = 0;
  mutable std::uint64_t considered_ = 0;
};

}  // namespace driftmesh::balancer
