#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "sizing/nearest_in_square.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The distance to the nearest of some segments, in the unit of their coordinates.
class SegmentDistance final : public PlaneFunction {
 public:
  struct Ends {
    Point a, b;
  };
  /// A segment from a point in a direction.
  struct Line {
    Point from, direction;
    double length;
  };
  /// To at least one segment.
  explicit SegmentDistance(std::vector<Ends> segments);
  /// To the segments with one of these markers; to all of them if there are no markers. The segments are copied.
  /// Throws Error if there are none.
  SegmentDistance(const Pslg& pslg, std::span<const std::int32_t> markers);

  /// Up to rounding errors of some units in the last place of the size of the domain. To the last bit the same within()
  /// any box.
  [[nodiscard]] double at(const Point& p) const override;
  /// The distance changes by at most the way between two points, so it differs from that at the box's center by at most
  /// half of the diagonal. Slopes are close where few segments are known to be nearest.
  [[nodiscard]] Variation over(const Box& box) const override;
  /// Knows the segments that can be nearest in the box, if they are few.
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;

 private:
  struct All;
  struct Nearest {
    const Line* line;
    double squared_distance;
  };
  SegmentDistance(std::shared_ptr<const All> all, std::vector<std::int32_t> few);
  [[nodiscard]] Nearest nearest(const Point& p) const;
  /// What may be nearer than this segment in a box.
  [[nodiscard]] NearestInSquare against(const Line& rival, const Box& box) const;

  std::shared_ptr<const All> all_;
  std::vector<std::int32_t> few_;  // the lines that can be nearest; none: any of all
};

}  // namespace driftmesh
