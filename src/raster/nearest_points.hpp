#pragma once

#include <cstdint>
#include <functional>

#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// Calls visit(i, j, near_i, near_j) for every point of a grid with the nearest of the points that are sought, where
/// `width` and `height` are the distances between columns and between rows; of several at the same distance that of the
/// lowest column, then row. Calls nothing if none is sought. A visit may change the values of points that are not
/// sought. Takes time in proportion to the grid (Meijster, Roerdink and Hesselink, "A general algorithm for computing
/// distance transforms in linear time", 2000, with parabolas as Felzenszwalb and Huttenlocher do).
void for_each_nearest(
    const TiledGrid& grid, double width, double height, const std::function<bool(float)>& is_sought,
    const std::function<void(std::int64_t i, std::int64_t j, std::int64_t near_i, std::int64_t near_j)>& visit);

}  // namespace driftmesh
