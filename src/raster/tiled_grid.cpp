#include "raster/tiled_grid.hpp"

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// What a file says of itself must not make numbers of values overflow.
const RasterFrame& checked(const RasterFrame& frame) {
  constexpr double kMost = 0x1p36;
  if (!(static_cast<double>(frame.columns) * static_cast<double>(frame.rows) <= kMost))
    throw LimitError("a raster has more than 68 billion values where it is needed; is its spacing right?");
  return frame;
}

}  // namespace

TiledGrid::TiledGrid(const RasterFrame& frame)
    : frame_(checked(frame)),
      across_((frame.columns + kSide - 1) / kSide),
      values_(static_cast<std::uint64_t>(across_ * ((frame.rows + kSide - 1) / kSide) * kSide * kSide)) {}

}  // namespace driftmesh
