#include "pslg/point_welder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/narrow.hpp"

namespace driftmesh {
namespace {

constexpr int kCellBits = 6;  // a cell is 2^6 times the power of two in what counts as close

std::uint64_t mix(std::uint64_t h) {
  h ^= h >> 32;
  h *= 0x9e3779b97f4a7c15u;
  return h ^ (h >> 29);
}

/// The reciprocal of a cell's size.
double scale_of(int level) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(2046 - kCellBits - level) << 52);
}

std::int64_t cell_at(double coordinate, double scale) {
  return static_cast<std::int64_t>(std::floor(coordinate * scale));
}

}  // namespace

PointWelder::PointWelder(std::size_t expected, const Closeness& closeness)
    : closeness_(closeness), slots_(std::bit_ceil(2 * expected + 16)) {
  points_.reserve(expected);
}

/// The biased exponent of a distance. Only the origin can have the distance 0; that of others is at least 2^-222.
int PointWelder::level_of(double close) {
  return static_cast<int>(std::bit_cast<std::uint64_t>(std::max(close, 0x1p-300)) >> 52);
}

PointWelder::Cell PointWelder::cell_of(const Point& p) const {
  const int level = level_of(closeness_(p));
  const double scale = scale_of(level);
  return {cell_at(p.x, scale), cell_at(p.y, scale), level};
}

std::uint64_t PointWelder::hash(const Cell& cell) {
  const auto x = static_cast<std::uint64_t>(cell.x), y = static_cast<std::uint64_t>(cell.y);
  return mix(x + mix(y + mix(static_cast<std::uint64_t>(cell.level))));
}

void PointWelder::search(const Cell& cell, const Point& p, Nearest& nearest) const {
  const std::size_t mask = slots_.size() - 1;
  const std::uint64_t hashed = hash(cell);
  for (std::size_t slot = hashed & mask; slots_[slot].index >= 0; slot = (slot + 1) & mask) {
    if (slots_[slot].tag != tag_of(hashed)) continue;
    const std::int32_t index = slots_[slot].index;
    const Point& q = points_[index];
    const double dx = p.x - q.x, dy = p.y - q.y, squared = dx * dx + dy * dy, close = closeness_(p, q);
    if (squared > close * close) continue;
    if (nearest.index < 0 || squared < nearest.squared || (squared == nearest.squared && index < nearest.index))
      nearest = {index, squared};
  }
}

/// The square of points that may be close to p is smaller than a cell, so its corners lie in all cells of a level that
/// it meets.
void PointWelder::search_level(int level, const Point& p, double reach, Nearest& nearest) const {
  const double scale = scale_of(level);
  const std::int64_t x0 = cell_at(p.x - reach, scale), x1 = cell_at(p.x + reach, scale);
  const std::int64_t y0 = cell_at(p.y - reach, scale), y1 = cell_at(p.y + reach, scale);
  for (std::int64_t x = x0; x <= x1; ++x)
    for (std::int64_t y = y0; y <= y1; ++y) search({x, y, level}, p, nearest);
}

std::int32_t PointWelder::add(const Point& p) {
  const double reach = closeness_(p) * 1.0001;
  // Cells are of another size where the larger coordinate passes a power of two.
  const double size = std::max(std::fabs(p.x), std::fabs(p.y));
  const int low = level_of(closeness_({size - reach, 0})), high = level_of(closeness_({size + reach, 0}));
  Nearest nearest;
  for (int level = low; level <= high; ++level) search_level(level, p, reach, nearest);
  if (nearest.index >= 0) return nearest.index;
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
