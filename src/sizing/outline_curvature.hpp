#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/box_tree.hpp"
#include "sizing/medial_axis.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The curvature of an outline at its point nearest to a place, in the inverse unit of its coordinates. At a point
/// where two segments meet it is 1 over the radius of the circle through that and their other ends (Menger curvature);
/// on a segment linear between its ends; elsewhere, where more or fewer segments meet, 0. At least a millionth over the
/// diagonal of the box around the outline, so that one may divide by it.
///
/// Where two points of the outline are nearest, curvatures jump.
class OutlineCurvature final : public PlaneFunction {
 public:
  /// The order of the segments does not matter. Throws Error if there are none.
  explicit OutlineCurvature(OutlineSegments outline);

  [[nodiscard]] double at(const Point& p) const override;
  /// Holds the curvatures of all segments that can be nearest, near those points that can be.
  [[nodiscard]] Variation over(const Box& box) const override;
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;

 private:
  struct Arc {
    Point a, b;
    double at_a, at_b;  // curvatures
  };
  struct All {
    std::vector<Arc> arcs;
    BoxTree tree;
    double least, most;  // curvatures
    double margin;       // for rounding, of distances
  };
  [[nodiscard]] double squared_to(const Point& p, std::int32_t item) const;
  [[nodiscard]] std::int32_t nearest(const Point& p) const;
  [[nodiscard]] std::vector<std::int32_t> candidates(const Box& box, std::size_t most) const;

  std::shared_ptr<const All> all_;
  std::vector<std::int32_t> few_;  // those that can be nearest, sorted; none: any
};

}  // namespace driftmesh
