#include "study/pdr/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "driftmesh/error.hpp"

namespace driftmesh::pdr {
namespace {

constexpr double kMostCells = 1 << 15;  // cells in a row or column

std::int32_t cells_along(double length, double side) {
  return static_cast<std::int32_t>(std::clamp(std::floor(length / side), 1.0, kMostCells));
}

/// The number of ranks side by side, so that blocks come as close to squares as `ranks` allows.
std::int32_t ranks_side_by_side(std::int32_t columns, std::int32_t rows, std::int32_t ranks) {
  const auto lopsided = [&](std::int32_t across) {
    return std::abs(std::log((1.0 * columns / across) / (1.0 * rows / (1.0 * ranks / across))));
  };
  std::int32_t best = 1;
  for (std::int32_t across = 2; across <= ranks; ++across)
    if (ranks % across == 0 && lopsided(across) < lopsided(best)) best = across;
  return best;
}

std::int32_t share_of(std::int32_t cell, std::int32_t cells, std::int32_t shares) {
  return static_cast<std::int32_t>(std::int64_t{cell} * shares / cells);
}

}  // namespace

Lattice::Lattice(const Point& low, const Point& high, double side, std::int32_t ranks) : low_(low), side_(side) {
  if (!(side > 0) || ranks < 1) throw Error("a lattice needs cells of positive size, and ranks");
  columns_ = cells_along(high.x - low.x, side);
  rows_ = cells_along(high.y - low.y, side);
  ranks_across_ = ranks_side_by_side(columns_, rows_, ranks);
  ranks_up_ = ranks / ranks_across_;
}

Cell Lattice::cell_of(const Point& p) const {
  const auto along = [this](double from, std::int32_t cells) {
    return static_cast<std::int32_t>(std::clamp(std::floor(from / side_), 0.0, cells - 1.0));
  };
  return {along(p.x - low_.x, columns_), along(p.y - low_.y, rows_)};
}

Rank Lattice::owner_of(Cell c) const {
  return Rank{share_of(c.row, rows_, ranks_up_) * ranks_across_ + share_of(c.column, columns_, ranks_across_)};
}

bool Lattice::is_near(Cell c, const Point& p) const {
  const auto near = [this](double from, std::int32_t cell, std::int32_t cells) {
    const double at = from / side_ - cell;
    return (at >= -0.5 || cell == 0) && (at <= 1.5 || cell == cells - 1);
  };
  return near(p.x - low_.x, c.column, columns_) && near(p.y - low_.y, c.row, rows_);
}

std::set<Rank> Lattice::followers_of(Cell c) const {
  std::set<Rank> owners;
  for (std::int32_t row = std::max(c.row - kReach, 0); row <= std::min(c.row + kReach, rows_ - 1); ++row)
    for (std::int32_t column = std::max(c.column - kReach, 0); column <= std::min(c.column + kReach, columns_ - 1);
         ++column)
      owners.insert(owner_of({column, row}));
  owners.erase(owner_of(c));
  return owners;
}

std::set<Rank> Lattice::neighbors_of(Rank r) const {
  std::set<Rank> neighbors;
  for (Cell c; c.row < rows_; ++c.row)
    for (c.column = 0; c.column < columns_; ++c.column)
      if (owner_of(c) == r) neighbors.merge(followers_of(c));
  return neighbors;
}

}  // namespace driftmesh::pdr
