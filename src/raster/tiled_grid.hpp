#pragma once

#include <cstdint>

#include "base/mapped_array.hpp"
#include "gis/raster_rows.hpp"

namespace driftmesh {

/// Values on a regular grid, in square tiles, so that what is near in the plane is near in memory or on disk.
class TiledGrid {
 public:
  /// Zeros at the points of a frame.
  explicit TiledGrid(const RasterFrame& frame);

  [[nodiscard]] const RasterFrame& frame() const { return frame_; }
  [[nodiscard]] float at(std::int64_t i, std::int64_t j) const { return values_[place(i, j)]; }
  void set(std::int64_t i, std::int64_t j, float value) { values_[place(i, j)] = value; }
  [[nodiscard]] Point point(std::int64_t i, std::int64_t j) const {
    return {frame_.first.x + static_cast<double>(i) * frame_.dx, frame_.first.y + static_cast<double>(j) * frame_.dy};
  }

 private:
  static constexpr int kBits = 6;
  static constexpr std::int64_t kSide = std::int64_t{1} << kBits;
  [[nodiscard]] std::uint64_t place(std::int64_t i, std::int64_t j) const {
    const std::int64_t tile = (j >> kBits) * across_ + (i >> kBits);
    return static_cast<std::uint64_t>((((tile << kBits) + (j & (kSide - 1))) << kBits) + (i & (kSide - 1)));
  }

  RasterFrame frame_;
  std::int64_t across_;  // tiles in a row
  MappedArray<float> values_;
};

}  // namespace driftmesh
