#include "sizing/sampled_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/mix.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMostTiles = 16384;   // tiles take 4 KB each; beyond, values are not kept
constexpr double kFinestStep = 1.0 / 1024;  // fraction of the spacing
constexpr int kMostSteps = 64;

/// The first and the last point of a grid from `low` to `high`, which are relative to its origin.
std::int64_t first_at(double low, double spacing) {
  return static_cast<std::int64_t>(std::ceil(low / spacing));
}

std::int64_t last_at(double high, double spacing) {
  return static_cast<std::int64_t>(std::floor(high / spacing));
}

/// From where to where a horizontal line meets the triangle.
std::array<double, 2> row_of(const CornerPoints& triangle, double y) {
  std::array<double, 2> row{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = triangle[k], &b = triangle[(k + 1) % 3];
    if ((a.y < y) == (b.y < y) && a.y != y) continue;
    const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
    row = {std::min(row[0], x), std::max(row[1], x)};
  }
  return row;
}

}  // namespace

std::size_t SampledField::TileHash::operator()(const std::array<std::int64_t, 2>& place) const {
  return mix(static_cast<std::uint64_t>(place[0]) * kMixStep + static_cast<std::uint64_t>(place[1]));
}

struct SampledField::Lowest {
  double length = std::numeric_limits<double>::infinity();
  std::int64_t i = 0, j = 0;
};

bool SampledField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  if (field_.falls_below(triangle, length)) return true;
  if (knows_ && knows_(triangle)) return false;
  const double limit = kCounts * length;
  const Lowest lowest = lowest_on_grid(triangle, limit);
  if (lowest.length < limit) return true;
  return is_steep(triangle, lowest, limit) && descends_below(triangle, at(lowest.i, lowest.j), lowest.length, limit);
}

/// Stops at the first that is less than `enough`.
SampledField::Lowest SampledField::lowest_on_grid(const std::array<Point, 3>& triangle, double enough) const {
  Lowest lowest;
  const auto [origin, spacing] = grid_;
  const Box box = Box::of(triangle);
  const std::int64_t top = last_at(box.high.y - origin.y, spacing);
  for (std::int64_t j = first_at(box.low.y - origin.y, spacing); j <= top; ++j) {
    const auto [left, right] = row_of(triangle, at(0, j).y);
    for (std::int64_t i = first_at(left - origin.x, spacing); i <= last_at(right - origin.x, spacing); ++i) {
      if (!contains(triangle, at(i, j))) continue;
      if (const double length = length_at(i, j); length < lowest.length) lowest = {length, i, j};
      if (lowest.length < enough) return lowest;
    }
  }
  return lowest;
}

/// Whether lengths rise so fast from the lowest point of the grid that they could fall below the limit beside it.
bool SampledField::is_steep(const std::array<Point, 3>& triangle, const Lowest& lowest, double limit) const {
  double rise = 0;
  const auto look = [&](std::int64_t i, std::int64_t j) {
    if (contains(triangle, at(i, j))) rise = std::max(rise, length_at(i, j) - lowest.length);
  };
  if (!(lowest.length < std::numeric_limits<double>::infinity())) return false;
  look(lowest.i - 1, lowest.j);
  look(lowest.i + 1, lowest.j);
  look(lowest.i, lowest.j - 1);
  look(lowest.i, lowest.j + 1);
  return lowest.length - rise < limit;
}

/// Pattern search (Hooke and Jeeves 1961).
bool SampledField::descends_below(const std::array<Point, 3>& triangle, Point from, double length, double limit) const {
  double step = grid_.spacing / 2;
  for (int steps = 0; steps < kMostSteps && step > kFinestStep * grid_.spacing; ++steps) {
    const Point start = from;
    for (const Point& p : {Point{start.x - step, start.y}, Point{start.x + step, start.y},
                           Point{start.x, start.y - step}, Point{start.x, start.y + step}}) {
      if (!contains(triangle, p)) continue;
      const double here = field_.edge_length(p);
      if (here < limit) return true;
      if (here >= length) continue;
      length = here;
      from = p;
    }
    if (from == start) step /= 2;
  }
  return false;
}

Point SampledField::at(std::int64_t i, std::int64_t j) const {
  return {grid_.origin.x + static_cast<double>(i) * grid_.spacing,
          grid_.origin.y + static_cast<double>(j) * grid_.spacing};
}

float SampledField::rounded_down(double length) const {
  const double exact = length / grid_.spacing;
  const auto rounded = static_cast<float>(exact);
  return rounded > exact ? std::nextafter(rounded, 0.0F) : rounded;
}

double SampledField::length_at(std::int64_t i, std::int64_t j) const {
  const auto tile_of = [](std::int64_t k) { return k >= 0 ? k / kTile : -((-k - 1) / kTile) - 1; };
  const std::int64_t u = tile_of(i), v = tile_of(j);
  const auto ask = [&] { return rounded_down(field_.edge_length(at(i, j))); };
  Tile* const tile = tile_at({u, v});
  if (tile == nullptr) return ask() * grid_.spacing;
  std::atomic<float>& value = (*tile)[static_cast<std::size_t>((j - v * kTile) * kTile + (i - u * kTile))];
  float known = value.load(std::memory_order_relaxed);
  if (std::isnan(known)) value.store(known = ask(), std::memory_order_relaxed);
  return known * grid_.spacing;
}

/// Null if there are too many already.
SampledField::Tile* SampledField::tile_at(const std::array<std::int64_t, 2>& place) const {
  const std::lock_guard lock(lock_);
  if (const auto known = tiles_.find(place); known != tiles_.end()) return known->second.get();
  if (tiles_.size() >= kMostTiles) return nullptr;
  auto made = std::make_unique<Tile>();
  for (std::atomic<float>& value : *made)
    value.store(std::numeric_limits<float>::quiet_NaN(), std::memory_order_relaxed);
  return tiles_.emplace(place, std::move(made)).first->second.get();
}

}  // namespace driftmesh
