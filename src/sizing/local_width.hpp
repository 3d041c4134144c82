#pragma once

#include <memory>
#include <vector>

#include "sizing/medial_axis.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The local width of a domain, in the unit of its coordinates: twice the sum of the distances to its outline and to
/// its medial axis, as far as medial_axis() counts that. In a channel with parallel sides it is the distance between
/// them, at any point. Nowhere is it more than four times as steep as the way is long.
class LocalWidth final : public PlaneFunction {
 public:
  /// The order of the segments does not matter. Throws Error if they enclose nothing.
  explicit LocalWidth(OutlineSegments outline);

  [[nodiscard]] double at(const Point& p) const override;
  /// No value is less than the width at the nearest point of the axis.
  [[nodiscard]] Variation over(const Box& box) const override;
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;

 private:
  struct Axis;
  [[nodiscard]] const AxisPiece& nearest(const Point& p) const;
  [[nodiscard]] double to_axis(const Point& p) const;

  std::shared_ptr<const PlaneFunction> to_outline_;
  std::shared_ptr<const Axis> axis_;
  std::vector<AxisPiece> few_;  // those that can be nearest; none: any
};

}  // namespace driftmesh
