#include "raster/tiled_grid.hpp"

namespace driftmesh {

TiledGrid::TiledGrid(const RasterFrame& frame)
    : frame_(frame),
      across_((frame.columns + kSide - 1) / kSide),
      values_(static_cast<std::uint64_t>(across_ * ((frame.rows + kSide - 1) / kSide) * kSide * kSide)) {}

}  // namespace driftmesh
