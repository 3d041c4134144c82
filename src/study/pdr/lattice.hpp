#pragma once

#include <cstdint>
#include <set>

#include "driftmesh/ids.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh::pdr {

struct Cell {
  std::int32_t column = 0;
  std::int32_t row = 0;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// Square cells over a domain, in four colors, and blocks of them dealt out to ranks. Two cells of one color have at
/// least one cell between them, so work that stays within half a side of its cell meets no other of its color. All
/// ranks have the same lattice, and ask it about each other.
class Lattice {
 public:
  static constexpr int kColors = 4;
  /// A rank follows what happens in its block and so many cells around it.
  static constexpr std::int32_t kReach = 2;

  /// Cells with edges of length `side` over the rectangle from `low` to `high`. Throws Error unless side is positive
  /// and ranks are.
  Lattice(const Point& low, const Point& high, double side, std::int32_t ranks);

  [[nodiscard]] std::int32_t columns() const { return columns_; }
  [[nodiscard]] std::int32_t rows() const { return rows_; }
  /// Points outside the rectangle belong to the nearest cell.
  [[nodiscard]] Cell cell_of(const Point& p) const;
  [[nodiscard]] static int color_of(Cell c) { return (c.column & 1) + 2 * (c.row & 1); }
  [[nodiscard]] Rank owner_of(Cell c) const;
  /// Whether p lies in the cell or within half a side of it.
  [[nodiscard]] bool is_near(Cell c, const Point& p) const;
  /// The ranks, without the cell's owner, that follow what happens in it.
  [[nodiscard]] std::set<Rank> followers_of(Cell c) const;
  /// The ranks that follow a cell of this rank's block: they are the same as those whose cells it follows.
  [[nodiscard]] std::set<Rank> neighbors_of(Rank r) const;

 private:
  Point low_;
  double side_;
  std::int32_t columns_, rows_;
  std::int32_t ranks_across_, ranks_up_;
};

}  // namespace driftmesh::pdr
