#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "geometry/box.hpp"
#include "raster/raster.hpp"

namespace driftmesh {

/// Rasters on top of each other, blended into one function: where the uppermost has the share s, its value counts by s,
/// and what is below it by 1 - s.
class RasterStack final : public Raster {
 public:
  struct Layer {
    std::shared_ptr<const Raster> values;
    std::shared_ptr<const Raster> share;  ///< from 0 to 1; null: 1 everywhere
    Box reach;                            ///< its share is 0 outside; of no use without one
  };

  /// The uppermost first. The last one, whatever its share is, counts wherever those above leave something.
  explicit RasterStack(std::vector<Layer> layers);

  [[nodiscard]] double at(const Point& p) const override;
  [[nodiscard]] Extent over(const Box& box) const override;
  [[nodiscard]] Slopes slopes_over(const Box& box) const override;
  /// The slopes of the layers, blended in the same way.
  [[nodiscard]] std::shared_ptr<const Raster> slope() const override;
  [[nodiscard]] std::span<const RasterFrame> frames() const override { return frames_; }

 private:
  struct Mixed;
  [[nodiscard]] Mixed mixed_over(const Box& box, bool with_slopes) const;

  std::vector<Layer> layers_;
  std::vector<RasterFrame> frames_;  // those of values and shares
  mutable std::once_flag has_slope_;
  mutable std::shared_ptr<const Raster> slope_;
};

}  // namespace driftmesh
