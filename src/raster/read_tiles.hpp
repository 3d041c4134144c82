#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "raster/mosaic_rows.hpp"
#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// Points of a frame: those from column `left` and row `bottom` of it on, as many as `part` has. Negative numbers, and
/// those beyond the frame, are points that it does not have.
struct FramePart {
  std::int64_t left = 0, bottom = 0;
  RasterFrame part;
};

/// The values of tiles, which are on one grid, at a part of `around`, the frame around all of them; NaN where none has
/// one. Where several have a value, that of the first counts. Threads read tile by tile, only what is needed, so that
/// memory does not depend on the number of tiles. Throws what reading a tile throws.
[[nodiscard]] TiledGrid read_tiles(const std::vector<RasterTile>& tiles, const RasterFrame& around,
                                   const FramePart& part, std::size_t threads);

/// Whether several threads may read files of these kinds at once: GeoTIFF and ESRI ASCII grids. What is in HDF5 has one
/// lock.
[[nodiscard]] bool can_be_read_at_once(const std::vector<std::string>& paths);

}  // namespace driftmesh
