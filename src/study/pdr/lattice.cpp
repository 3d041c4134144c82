#include "study/pdr/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"

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

/// The first cell of a share.
std::int32_t begin_of(std::int32_t share, std::int32_t cells, std::int32_t shares) {
  return static_cast<std::int32_t>((std::int64_t{share} * cells + shares - 1) / shares);
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

bool Lattice::Span::reaches(Span other) const {
  return first < last && other.first < other.last && first < other.last + kReach && other.first < last + kReach;
}

std::array<Lattice::Span, 2> Lattice::block(Rank r) const {
  const auto span = [](std::int32_t share, std::int32_t cells, std::int32_t shares) {
    return Span{begin_of(share, cells, shares), begin_of(share + 1, cells, shares)};
  };
  return {span(to_int(r) % ranks_across_, columns_, ranks_across_), span(to_int(r) / ranks_across_, rows_, ranks_up_)};
}

bool Lattice::reaches(const std::array<Span, 2>& block_of_one, Rank r) const {
  const auto other = block(r);
  return block_of_one[0].reaches(other[0]) && block_of_one[1].reaches(other[1]);
}

std::vector<Rank> Lattice::reached_by(const std::array<Span, 2>& cells, Rank except) const {
  std::vector<Rank> reached;
  for (const Rank r : first_ids<Rank>(ranks_across_ * ranks_up_))
    if (r != except && reaches(cells, r)) reached.push_back(r);
  return reached;
}

std::vector<Rank> Lattice::followers_of(Cell c) const {
  return reached_by({Span{c.column, c.column + 1}, Span{c.row, c.row + 1}}, owner_of(c));
}

std::vector<Rank> Lattice::neighbors_of(Rank r) const {
  return reached_by(block(r), r);
}

}  // namespace driftmesh::pdr
