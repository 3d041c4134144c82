#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "decompose/outline.hpp"

namespace driftmesh {

/// The goal of cutting one piece.
struct CutGoal {
  std::int32_t parts = 2;  ///< number of subdomains to be made of the piece; >= 2
  double load = 1;         ///< work per part in this piece over that in the whole domain
  double bias = 1;         ///< work that the side between the stations is to get, relative to its fair share
  double angle = 0;        ///< radians; the one the outline was read with
  double clearance = 0;    ///< distance to keep from other corners, in units of the shorter of spacing and separator
  std::size_t max_stations = 64;  ///< more are thinned out before all pairs are tried
};

/// A straight separator between two stations of an outline, first < second.
struct Cut {
  std::size_t first = 0, second = 0;
  std::int32_t parts_between = 0;  ///< parts of the side whose border runs from first to second; 0: no cut was found
  double share_between = 0;        ///< of the piece's work
  double cost = 0;
  explicit operator bool() const { return parts_between != 0; }
};

/// Finds the best straight cut of a piece with one loop: all pairs of stations (of a selection if there are many, then
/// their neighbors) are ranked by the expected separator length of the finished decomposition and by the balance of
/// work; the best one that stays inside the piece wins. The object keeps its buffers between searches.
class CutSearch {
 public:
  Cut find(const PlanarMap& map, const Outline& outline, const CutGoal& goal);

 private:
  void select_stations();
  void rank_pairs();
  void rank(std::size_t i, std::size_t j, std::vector<Cut>& ranked) const;
  Cut first_inside(std::vector<Cut>& ranked) const;
  [[nodiscard]] Cut refine(Cut cut);
  [[nodiscard]] bool stays_inside(std::size_t i, std::size_t j) const;

  const PlanarMap* map_ = nullptr;
  const Outline* outline_ = nullptr;
  CutGoal goal_;
  std::size_t stride_ = 1;
  std::vector<std::size_t> selected_;
  std::vector<Cut> ranked_;
  std::vector<Cut> nearby_;
};

}  // namespace driftmesh
