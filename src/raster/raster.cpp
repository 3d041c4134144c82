#include "raster/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace driftmesh {
namespace {

constexpr double kTouch = 0x1p-40;         // spacings: a box that reaches so far beyond a grid line only touches it
constexpr double kFewSteps = 3 + 0x1p-20;  // no count that boxes have by chance
constexpr double kManySteps = 8 + 0x1p-20;

/// As a count of spacings from the first point, no farther than the last one. Never falls as x rises, rounded as it is.
double steps_to(double x, double first, double spacing, std::int64_t count) {
  return std::clamp((x - first) / spacing, 0.0, static_cast<double>(count - 1));
}

/// The difference of the values on both sides of a point, where there are some, per unit of length.
template <class Value>
double rise(std::int64_t i, std::int64_t count, double spacing, const Value& value) {
  const std::int64_t before = std::max<std::int64_t>(i - 1, 0), behind = std::min(i + 1, count - 1);
  if (before == behind) return 0;
  return (static_cast<double>(value(behind)) - static_cast<double>(value(before))) /
         (spacing * static_cast<double>(behind - before));
}

TiledGrid slopes_of(const TiledGrid& grid) {
  const RasterFrame& frame = grid.frame();
  TiledGrid slopes(frame);
  for (std::int64_t j = 0; j < frame.rows; ++j)
    for (std::int64_t i = 0; i < frame.columns; ++i) {
      const double east = rise(i, frame.columns, frame.dx, [&](std::int64_t k) { return grid.at(k, j); });
      const double north = rise(j, frame.rows, frame.dy, [&](std::int64_t k) { return grid.at(i, k); });
      slopes.set(i, j, static_cast<float>(std::sqrt(east * east + north * north)));
    }
  return slopes;
}

/// The points of a line of the grid around a stretch from `low` to `high`, in steps from the first point. Where a frame
/// begins by some units in the last place elsewhere, they are the same.
struct Around {
  std::int64_t first, last;
};
Around points_around(double low, double high, std::int64_t count) {
  return {std::min(static_cast<std::int64_t>(std::floor(low + kTouch)), count - 1),
          std::min(static_cast<std::int64_t>(std::floor(high - kTouch)) + 1, count - 1)};
}

}  // namespace

GridRaster::GridRaster(TiledGrid grid)
    : grid_(std::move(grid)),
      pyramid_(grid_),
      largest_(pyramid_.over(grid_, 0, 0, frame().columns - 1, frame().rows - 1)),
      rounding_(4 * kTouch * std::max(std::abs(largest_.low), std::abs(largest_.high))) {}

double GridRaster::column_at(double x) const {
  return steps_to(x, frame().first.x, frame().dx, frame().columns);
}

double GridRaster::row_at(double y) const {
  return steps_to(y, frame().first.y, frame().dy, frame().rows);
}

/// At a place in steps from the first point.
double GridRaster::value(double u, double v) const {
  const auto i = static_cast<std::int64_t>(u), j = static_cast<std::int64_t>(v);
  const std::int64_t right = std::min(i + 1, frame().columns - 1), above = std::min(j + 1, frame().rows - 1);
  const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
  const double a = grid_.at(i, j), b = grid_.at(right, j), c = grid_.at(i, above), d = grid_.at(right, above);
  const double low = a + (b - a) * s, high = c + (d - c) * s;
  return std::clamp(low + (high - low) * t, std::min({a, b, c, d}), std::max({a, b, c, d}));  // rounding aside
}

double GridRaster::at(const Point& p) const {
  return value(column_at(p.x), row_at(p.y));
}

Extent GridRaster::over(const Box& box) const {
  const std::array<double, 4> steps{column_at(box.low.x), row_at(box.low.y), column_at(box.high.x), row_at(box.high.y)};
  if (steps[2] - steps[0] <= kFewSteps && steps[3] - steps[1] <= kFewSteps) return exact_over(steps);
  const Around i = points_around(steps[0], steps[2], frame().columns),
               j = points_around(steps[1], steps[3], frame().rows);
  const Extent found = pyramid_.over(grid_, i.first, j.first, i.last, j.last);
  return {std::max(found.low - rounding_, largest_.low), std::min(found.high + rounding_, largest_.high)};
}

/// On a rectangle within four points of the grid, a bilinear function is extreme at corners.
Extent GridRaster::exact_over(const std::array<double, 4>& steps) const {
  Extent found{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto next = [](double from, double last) {
    return from < last ? std::min(std::floor(from) + 1, last) : last + 1;
  };
  for (double v = steps[1]; v <= steps[3]; v = next(v, steps[3]))
    for (double u = steps[0]; u <= steps[2]; u = next(u, steps[2])) {
      const double here = value(u, v);
      found = {std::min(found.low, here), std::max(found.high, here)};
    }
  return {std::max(found.low - rounding_, largest_.low), std::min(found.high + rounding_, largest_.high)};
}

/// Within four points of the grid, slopes in one direction are linear in the other.
Raster::Slopes GridRaster::slopes_over(const Box& box) const {
  constexpr double kSteepest = std::numeric_limits<double>::infinity();
  const std::array<double, 4> steps{column_at(box.low.x), row_at(box.low.y), column_at(box.high.x), row_at(box.high.y)};
  if (!(steps[2] - steps[0] <= kManySteps && steps[3] - steps[1] <= kManySteps))
    return {{-kSteepest, kSteepest}, {-kSteepest, kSteepest}};
  const auto [i0, i1] = points_around(steps[0], steps[2], frame().columns);
  const auto [j0, j1] = points_around(steps[1], steps[3], frame().rows);
  Extent rises{0, 0}, climbs{0, 0};  // outside of the grid, values do not change
  const auto within = [](double low, double high, double first, double spacing, std::int64_t count) {
    return low - first >= -kTouch * spacing && high - first <= (static_cast<double>(count - 1) + kTouch) * spacing;
  };
  const bool inside = i1 > i0 && j1 > j0 &&
                      within(box.low.x, box.high.x, frame().first.x, frame().dx, frame().columns) &&
                      within(box.low.y, box.high.y, frame().first.y, frame().dy, frame().rows);
  if (inside) rises = climbs = {kSteepest, -kSteepest};
  const auto extend = [](Extent& e, double by) { e = {std::min(e.low, by), std::max(e.high, by)}; };
  for (std::int64_t j = j0; j <= j1; ++j)
    for (std::int64_t i = i0; i <= i1; ++i) {
      const double here = grid_.at(i, j);
      if (i < i1) extend(rises, grid_.at(i + 1, j) - here);
      if (j < j1) extend(climbs, grid_.at(i, j + 1) - here);
    }
  const auto scaled = [](const Extent& e, double spacing) { return Extent{e.low / spacing, e.high / spacing}; };
  return {scaled(rises, frame().dx), scaled(climbs, frame().dy)};
}

std::shared_ptr<const Raster> GridRaster::slope() const {
  std::call_once(has_slope_, [this] { slope_ = std::make_shared<const GridRaster>(slopes_of(grid_)); });
  return slope_;
}

}  // namespace driftmesh
