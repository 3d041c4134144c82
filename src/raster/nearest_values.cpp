#include "raster/nearest_values.hpp"

#include <algorithm>
#include <cmath>

#include "raster/nearest_points.hpp"

namespace driftmesh {

std::int64_t count_missing(const TiledGrid& grid) {
  std::int64_t missing = 0;
  for (std::int64_t j = 0; j < grid.frame().rows; ++j)
    for (std::int64_t i = 0; i < grid.frame().columns; ++i) missing += std::isnan(grid.at(i, j)) ? 1 : 0;
  return missing;
}

std::int64_t fill_from_nearest(TiledGrid& grid, double width, double height) {
  const std::int64_t missing = count_missing(grid);
  if (missing == 0) return 0;
  for_each_nearest(
      grid, width, height, [](float value) { return !std::isnan(value); },
      [&](std::int64_t i, std::int64_t j, std::int64_t near_i, std::int64_t near_j) {
        // What has a value is the nearest to itself, so that no value is taken that was filled in.
        if (near_j != j || near_i != i) grid.set(i, j, grid.at(near_i, near_j));
      });
  return missing;
}

TiledGrid shares_of(const TiledGrid& grid, double width, double height, double ramp) {
  TiledGrid shares(grid.frame());
  for_each_nearest(
      grid, width, height, [](float value) { return std::isnan(value); },
      [&](std::int64_t i, std::int64_t j, std::int64_t near_i, std::int64_t near_j) {
        const double away =
            std::hypot(width * static_cast<double>(i - near_i), height * static_cast<double>(j - near_j));
        shares.set(i, j, static_cast<float>(std::min(away / ramp, 1.0)));
      });
  return shares;
}

}  // namespace driftmesh
