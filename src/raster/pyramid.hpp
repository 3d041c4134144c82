#pragma once

#include <cstdint>
#include <vector>

#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// The least and the greatest of some values.
struct Extent {
  double low, high;
};

/// The least and greatest values of blocks of a grid, of blocks of these, and so on.
class ValuePyramid {
 public:
  explicit ValuePyramid(const TiledGrid& grid);

  /// The extent over a range of columns and rows, all included. Exact for small ranges; for others of up to a quarter
  /// more in each direction. `grid`: the same.
  [[nodiscard]] Extent over(const TiledGrid& grid, std::int64_t i0, std::int64_t j0, std::int64_t i1,
                            std::int64_t j1) const;

 private:
  static constexpr int kBits = 3;  // blocks of the lowest level have 2^kBits columns and rows
  struct Pair {
    float low, high;
  };
  struct Level {
    std::int64_t columns = 0, rows = 0;
    std::vector<Pair> blocks;
  };

  std::vector<Level> levels_;
};

}  // namespace driftmesh
