#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>

#include "geometry/box.hpp"
#include "raster/pyramid.hpp"
#include "raster/tiled_grid.hpp"

namespace driftmesh {

/// Values as a continuous function of position. Queries depend on their arguments alone and may run in several threads
/// at once.
class Raster {
 public:
  /// Slopes along lines parallel to the axes.
  struct Slopes {
    Extent in_x, in_y;
  };

  virtual ~Raster() = default;
  [[nodiscard]] virtual double at(const Point& p) const = 0;
  /// Holds at(p) for all points of a box, whose ends may be infinite.
  [[nodiscard]] virtual Extent over(const Box& box) const = 0;
  /// Hold all slopes of at() between points of a box that are not closer to its border than rounding could move a line
  /// of a grid; infinite for large boxes.
  [[nodiscard]] virtual Slopes slopes_over(const Box& box) const = 0;
  /// The slope of the values: the length of the gradient, per unit of length of the coordinates. Is made when it is
  /// first asked for.
  [[nodiscard]] virtual std::shared_ptr<const Raster> slope() const = 0;
  /// The grids between whose lines at() is smooth.
  [[nodiscard]] virtual std::span<const RasterFrame> frames() const = 0;
};

/// Values on a grid: bilinear between four points of the grid, and outside of the grid that of its nearest point.
class GridRaster final : public Raster {
 public:
  /// All values are finite.
  explicit GridRaster(TiledGrid grid);

  [[nodiscard]] const RasterFrame& frame() const { return grid_.frame(); }
  /// Never beyond the values at the four points of the grid around it.
  [[nodiscard]] double at(const Point& p) const override;
  /// Exact but for rounding if the box extends over few points of the grid, and otherwise the least and greatest values
  /// of blocks of the grid.
  [[nodiscard]] Extent over(const Box& box) const override;
  /// Exact if the box extends over few points of the grid.
  [[nodiscard]] Slopes slopes_over(const Box& box) const override;
  /// At points of the grid by differences of their neighbors' values (one-sided at its rim), bilinear in between.
  [[nodiscard]] std::shared_ptr<const Raster> slope() const override;
  [[nodiscard]] std::span<const RasterFrame> frames() const override { return {&grid_.frame(), 1}; }

 private:
  [[nodiscard]] double value(double u, double v) const;
  [[nodiscard]] Extent exact_over(const std::array<double, 4>& steps) const;
  [[nodiscard]] double column_at(double x) const;
  [[nodiscard]] double row_at(double y) const;

  TiledGrid grid_;
  ValuePyramid pyramid_;
  Extent largest_;   // least and greatest of all values
  double rounding_;  // covers what is computed between points of the grid, and where these are
  mutable std::once_flag has_slope_;
  mutable std::shared_ptr<const Raster> slope_;
};

}  // namespace driftmesh
