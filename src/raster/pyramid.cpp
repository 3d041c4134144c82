#include "raster/pyramid.hpp"

#include <algorithm>
#include <limits>

namespace driftmesh {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::int64_t kFew = 4;  // blocks that a range may extend over in each direction, and one more

}  // namespace

ValuePyramid::ValuePyramid(const TiledGrid& grid) {
  const RasterFrame& frame = grid.frame();
  constexpr std::int64_t kSide = std::int64_t{1} << kBits;
  Level lowest{(frame.columns + kSide - 1) / kSide, (frame.rows + kSide - 1) / kSide, {}};
  lowest.blocks.assign(static_cast<std::size_t>(lowest.columns * lowest.rows), {kFar, -kFar});
  const auto add = [](Pair& to, const Pair& other) {
    to = {std::min(to.low, other.low), std::max(to.high, other.high)};
  };
  for (std::int64_t j = 0; j < frame.rows; ++j)
    for (std::int64_t i = 0; i < frame.columns; ++i)
      add(lowest.blocks[static_cast<std::size_t>((j >> kBits) * lowest.columns + (i >> kBits))],
          {grid.at(i, j), grid.at(i, j)});
  levels_.push_back(std::move(lowest));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    const Level& below = levels_.back();
    Level next{(below.columns + 1) / 2, (below.rows + 1) / 2, {}};
    next.blocks.assign(static_cast<std::size_t>(next.columns * next.rows), {kFar, -kFar});
    for (std::int64_t j = 0; j < below.rows; ++j)
      for (std::int64_t i = 0; i < below.columns; ++i)
        add(next.blocks[static_cast<std::size_t>(j / 2 * next.columns + i / 2)],
            below.blocks[static_cast<std::size_t>(j * below.columns + i)]);
    levels_.push_back(std::move(next));
  }
}

Extent ValuePyramid::over(const TiledGrid& grid, std::int64_t i0, std::int64_t j0, std::int64_t i1,
                          std::int64_t j1) const {
  Extent found{kFar, -kFar};
  const auto add = [&](double low, double high) { found = {std::min(found.low, low), std::max(found.high, high)}; };
  if (i1 - i0 <= 2 * kFew && j1 - j0 <= 2 * kFew) {
    for (std::int64_t j = j0; j <= j1; ++j)
      for (std::int64_t i = i0; i <= i1; ++i) add(grid.at(i, j), grid.at(i, j));
    return found;
  }
  std::size_t level = 0;
  int shift = kBits;
  for (; (i1 >> shift) - (i0 >> shift) > kFew || (j1 >> shift) - (j0 >> shift) > kFew; ++shift) ++level;
  const Level& blocks = levels_[level];
  for (std::int64_t j = j0 >> shift; j <= j1 >> shift; ++j)
    for (std::int64_t i = i0 >> shift; i <= i1 >> shift; ++i) {
      const Pair& block = blocks.blocks[static_cast<std::size_t>(j * blocks.columns + i)];
      add(block.low, block.high);
    }
  return found;
}

}  // namespace driftmesh
