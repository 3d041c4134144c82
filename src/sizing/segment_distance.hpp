#pragma once

#include <cstdint>
#include <span>

#include "driftmesh/pslg.hpp"
#include "geometry/box.hpp"
#include "sizing/nearest_cells.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The distance to the nearest of some segments, in the unit of their coordinates. Queries are const, depend on their
/// arguments alone, and may run in several threads at once.
class SegmentDistance final : public PlaneFunction {
 public:
  /// To the segments with one of these markers; to all of them if there are no markers. The segments are copied.
  /// Throws Error if there are none.
  SegmentDistance(const Pslg& pslg, std::span<const std::int32_t> markers);

  /// Up to rounding errors of some units in the last place of the size of the domain.
  [[nodiscard]] double at(const Point& p) const override;
  /// Holds at(p) for all points of a box, whose ends may be infinite: the distance changes by at most the way between
  /// two points, so it differs from that at the box's center by at most half of the diagonal.
  [[nodiscard]] Interval over(const Box& box) const override;

 private:
  NearestCells segments_;
  double extent_;  // diagonal of the box around all segments
};

}  // namespace driftmesh
