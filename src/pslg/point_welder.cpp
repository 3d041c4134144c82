#include "pslg/point_welder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/narrow.hpp"
#include "pslg/closeness.hpp"

namespace driftmesh {
namespace {

constexpr int kCellBits = 44;  // a cell has 2^-44 of the larger coordinate's power of two: 2^8 ulps

std::uint64_t mix(std::uint64_t h) {
  h ^= h >> 32;
  h *= 0x9e3779b97f4a7c15u;
  return h ^ (h >> 29);
}

}  // namespace

PointWelder::PointWelder(std::size_t expected) : slots_(std::bit_ceil(2 * expected + 16)) {
  points_.reserve(expected);
}

PointWelder::Cell PointWelder::cell_of(const Point& p) {
  const double size = std::max(std::fabs(p.x), std::fabs(p.y));
  if (size == 0) return {};
  // The biased exponent of a normal number; coordinates are normal (predicates.hpp), and 2^(kCellBits - e) as well.
  const int biased = static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52);
  const double scale = std::bit_cast<double>(static_cast<std::uint64_t>(2046 + kCellBits - biased) << 52);
  return {static_cast<std::int64_t>(std::floor(p.x * scale)), static_cast<std::int64_t>(std::floor(p.y * scale)),
          biased};
}

std::uint64_t PointWelder::hash(const Cell& cell) {
  const auto x = static_cast<std::uint64_t>(cell.x), y = static_cast<std::uint64_t>(cell.y);
  return mix(x + mix(y + mix(static_cast<std::uint64_t>(cell.exponent))));
}

void PointWelder::search(const Cell& cell, const Point& p, std::int32_t& best) const {
  const double margin = closeness(p);
  const std::size_t mask = slots_.size() - 1;
  const std::uint64_t hashed = hash(cell);
  for (std::size_t slot = hashed & mask; slots_[slot].index >= 0; slot = (slot + 1) & mask) {
    if (slots_[slot].tag != tag_of(hashed)) continue;
    const std::int32_t index = slots_[slot].index;
    const Point& q = points_[index];
    const double reach = std::max(margin, closeness(q));
    if (std::fabs(p.x - q.x) > reach || std::fabs(p.y - q.y) > reach) continue;
    if (best < 0 || p == q || index < best) best = index;
    if (p == q) return;
  }
}

std::int32_t PointWelder::add(const Point& p) {
  // The square of points that may be close to p is smaller than a cell, so its corners lie in all cells that it meets.
  const double reach = closeness(p) * 1.0001;
  std::array<Cell, 4> cells;
  std::size_t count = 0;
  std::int32_t best = -1;
  for (const double sx : {-reach, reach})
    for (const double sy : {-reach, reach}) {
      const Cell cell = cell_of({p.x + sx, p.y + sy});
      if (std::find(cells.begin(), cells.begin() + count, cell) != cells.begin() + count) continue;
      cells[count++] = cell;
      search(cell, p, best);
    }
  if (best >= 0) return best;
  const auto index = narrow<std::int32_t>(points_.size(), "vertices");
  points_.push_back(p);
  if (2 * points_.size() > slots_.size()) grow();
  insert(index);
  return index;
}

void PointWelder::insert(std::int32_t index) {
  const std::size_t mask = slots_.size() - 1;
  const std::uint64_t hashed = hash(cell_of(points_[index]));
  std::size_t slot = hashed & mask;
  while (slots_[slot].index >= 0) slot = (slot + 1) & mask;
  slots_[slot] = {tag_of(hashed), index};
}

void PointWelder::grow() {
  slots_.assign(2 * slots_.size(), {});
  for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(points_.size()); ++i) insert(i);
}

}  // namespace driftmesh
