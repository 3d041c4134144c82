#pragma once

#include <cstddef>
#include <optional>

#include "decompose/cut_search.hpp"
#include "decompose/fork.hpp"
#include "decompose/outline.hpp"
#include "decompose/pieces.hpp"
#include "decompose/planar_map.hpp"
#include "decompose/work_samples.hpp"

namespace driftmesh {

/// A cut of a piece, with the stations that it joins.
struct FoundCut {
  Cut cut;
  Outline::Station first, second;
  explicit operator bool() const { return static_cast<bool>(cut); }
};

/// What a piece's cut is to achieve.
struct Fairness {
  double load = 1;      ///< work per part in the piece over that in the whole domain
  double bias = 1;      ///< see CutGoal
  bool uneven = false;  ///< whether loads do not matter
};

/// Finds cuts of pieces, with more effort where that is needed. Only reads the map, so that several can work at once.
class CutFinder {
 public:
  /// `angle`: radians, the least that separators should make.
  CutFinder(const PlanarMap& map, double angle) : map_(map), angle_(angle) {}

  [[nodiscard]] FoundCut find(const Piece& piece, const WorkSamples& samples, const Fairness& fairness);
  /// Into three pieces of about equal area.
  [[nodiscard]] std::optional<Fork> find_fork(const Piece& piece);

 private:
  const PlanarMap& map_;
  double angle_;
  Outline outline_;
  CutSearch search_;
};

}  // namespace driftmesh
