#pragma once

#include <cstdint>

#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// How many points of a grid have no value (NaN).
[[nodiscard]] std::int64_t count_missing(const TiledGrid& grid);

/// Gives every point of a grid without a value (NaN) that of the nearest point that has one (see for_each_nearest).
/// Returns how many had none; if all, nothing changes.
std::int64_t fill_from_nearest(TiledGrid& grid, double width, double height);

/// How much the values of a grid count where other values meet them: 0 at points without a value (NaN), of which there
/// is at least one, rising to 1 at the distance `ramp` from the nearest of these.
[[nodiscard]] TiledGrid shares_of(const TiledGrid& grid, double width, double height, double ramp);

}  // namespace driftmesh
