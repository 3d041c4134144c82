#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "decompose/cut_candidates.hpp"
#include "decompose/outline.hpp"
#include "geometry/box_tree.hpp"

namespace driftmesh {

/// What decides whether a separator may leave: of some stations, the place and the limits of the sector.
struct StationColumns {
  static constexpr std::size_t kBlock = 4;  ///< columns are filled up to whole blocks with what is no number
  std::vector<double> x, y, first_x, first_y, last_x, last_y;
  void set(const Outline& outline, std::span<const std::uint32_t> selected);
  [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// Finds the best straight cut of a piece with one loop: all pairs of stations (of a selection if there are many, then
/// their neighbors) are ranked by the expected separator length of the finished decomposition and by the balance of
/// work; the best one that stays inside the piece wins. The object keeps its buffers between searches.
class CutSearch {
 public:
  Cut find(const Outline& outline, const CutGoal& goal);

 private:
  void select_stations();
  void collect_pairs();
  [[nodiscard]] bool allows(std::size_t i, std::size_t j) const;
  [[nodiscard]] Cut best_inside(double limit);
  [[nodiscard]] Cut refine(Cut cut);
  void set_sides();
  [[nodiscard]] bool stays_inside(std::size_t i, std::size_t j) const;

  const Outline* outline_ = nullptr;
  BoxTree sides_;  // those of the loop, if it has so many that not all should be looked at for each separator
  CutGoal goal_;
  std::size_t stride_ = 1;
  std::vector<std::uint32_t> selected_;
  StationColumns columns_;
  CutCandidates candidates_;
};

}  // namespace driftmesh
