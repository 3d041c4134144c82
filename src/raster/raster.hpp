#pragma once

#include <array>
#include <memory>
#include <mutex>

#include "geometry/box.hpp"
#include "raster/pyramid.hpp"
#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// Values on a grid as a continuous function of position: bilinear between four points of the grid, and outside of the
/// grid that of its nearest point. Queries depend on their arguments alone and may run in several threads at once.
class Raster {
 public:
  /// All values are finite.
  explicit Raster(TiledGrid grid);

  [[nodiscard]] const RasterFrame& frame() const { return grid_.frame(); }
  /// The value at a point: never beyond those at the four points of the grid around it.
  [[nodiscard]] double at(const Point& p) const;
  /// Holds at(p) for all points of a box, whose ends may be infinite: exact but for rounding if the box extends over
  /// few points of the grid, and otherwise the least and greatest values of blocks of the grid.
  [[nodiscard]] Extent over(const Box& box) const;

  /// Slopes along lines parallel to the axes.
  struct Slopes {
    Extent in_x, in_y;
  };
  /// Hold all slopes of at() between points of a box that are not closer to its border than rounding could move a line
  /// of the grid, exactly if it extends over few points of the grid; infinite for larger boxes.
  [[nodiscard]] Slopes slopes_over(const Box& box) const;

  /// The slope of the values: the length of the gradient, per unit of length of the coordinates. At points of the grid
  /// by differences of their neighbors' values (one-sided at its rim), bilinear in between. Is made when it is first
  /// asked for.
  [[nodiscard]] std::shared_ptr<const Raster> slope() const;

 private:
  [[nodiscard]] double value(double u, double v) const;
  [[nodiscard]] Extent exact_over(const std::array<double, 4>& steps) const;
  [[nodiscard]] double column_at(double x) const;
  [[nodiscard]] double row_at(double y) const;

  TiledGrid grid_;
  ValuePyramid pyramid_;
  Extent largest_;   // of all values
  double rounding_;  // of values between points of the grid, and of where these are
  mutable std::once_flag has_slope_;
  mutable std::shared_ptr<const Raster> slope_;
};

}  // namespace driftmesh
