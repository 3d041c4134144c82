#pragma once

#include <cstdint>

#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// Gives every point of a grid without a value (NaN) that of the nearest point that has one, where `width` and `height`
/// are the distances between columns and between rows; of several at the same distance that of the lowest column, then
/// row. Returns how many had none; if all, nothing changes. Takes time in proportion to the grid (Meijster, Roerdink
/// and Hesselink, "A general algorithm for computing distance transforms in linear time", 2000, with parabolas as
/// Felzenszwalb and Huttenlocher do).
std::int64_t fill_from_nearest(TiledGrid& grid, double width, double height);

}  // namespace driftmesh
