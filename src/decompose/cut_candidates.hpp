#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "decompose/outline.hpp"

namespace driftmesh {

/// The goal of cutting one piece.
struct CutGoal {
  std::int32_t parts = 2;  ///< number of subdomains to be made of the piece; >= 2
  double load = 1;         ///< work per part in this piece over that in the whole domain
  double bias = 1;         ///< work that the side between the stations is to get, relative to its fair share
  double clearance = 0;    ///< distance to keep from other corners, in units of the shorter of spacing and separator
  std::size_t max_stations = 64;  ///< more are thinned out before all pairs are tried
};

/// A straight separator between two stations of an outline, first < second.
struct Cut {
  std::size_t first = 0, second = 0;
  std::int32_t parts_between = 0;  ///< parts of the side whose border runs from first to second; 0: no cut was found
  double share_between = 0;        ///< fraction of the piece's work
  double cost = 0;
  explicit operator bool() const { return parts_between != 0; }
};

/// Pairs of stations with their costs, in columns: most of the time of a decomposition goes into a few short loops over
/// them, which the compiler turns into vector instructions.
class CutCandidates {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();  ///< the cost of an impossible cut

  void clear() { pairs_.clear(); }
  /// Adds the pair of stations i < j. Pairs come in ascending order.
  void add(std::size_t i, std::size_t j) {
    pairs_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
  }
  template <class Possible>
  void keep(const Possible& possible) {
    std::erase_if(pairs_, [&](const Pair& pair) { return !possible(pair.first, pair.second); });
  }
  /// Computes the costs of all pairs.
  void rank(const Outline& outline, const CutGoal& goal);
  /// The cut of least cost below `limit` that is `possible`, the first among equals.
  template <class Possible>
  [[nodiscard]] Cut best(double limit, const Possible& possible);

 private:
  struct Pair {
    std::uint32_t first, second;
  };
  void measure(const Outline& outline);
  [[nodiscard]] std::size_t cheapest() const;
  [[nodiscard]] bool worse(std::uint32_t k, std::uint32_t l) const {
    return cost_[k] != cost_[l] ? cost_[k] > cost_[l] : k > l;
  }
  void make_heap();
  void pop_heap();
  [[nodiscard]] Cut cut(std::size_t k) const {
    return {pairs_[k].first, pairs_[k].second, parts_[k], share_[k], cost_[k]};
  }

  static constexpr int kScans = 8;  ///< before a heap pays

  std::vector<Pair> pairs_;
  std::vector<double> length_, border_, area_, share_;  // border and area of the side between the stations
  std::vector<double> opposite_;                        // ends at stations that are opposite to others
  std::vector<std::int32_t> parts_;
  std::vector<double> cost_;
  std::vector<std::uint32_t> heap_;
};

template <class Possible>
Cut CutCandidates::best(double limit, const Possible& possible) {
  for (int scan = 0; scan < kScans; ++scan) {
    const std::size_t k = cheapest();
    if (pairs_.empty() || cost_[k] >= limit) return {};
    if (possible(pairs_[k].first, pairs_[k].second)) return cut(k);
    cost_[k] = kNever;
  }
  for (make_heap(); !heap_.empty(); pop_heap()) {
    const std::size_t k = heap_.front();
    if (cost_[k] >= limit) break;
    if (possible(pairs_[k].first, pairs_[k].second)) return cut(k);
  }
  return {};
}

}  // namespace driftmesh
