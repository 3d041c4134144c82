#pragma once

#include <limits>
#include <memory>
#include <string>

#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "sizing/interval.hpp"
#include "sizing/named_raster.hpp"

namespace driftmesh {

/// The target edge length as an expression in x and y, for example "0.01 + 0.2*sqrt(x^2 + y^2)". The operators,
/// functions and conditionals are those of muParser, with pi, e and hypot(a, b) in addition, and distance(1, 2), the
/// distance to the nearest segment with one of these markers; distance() is that to the nearest segment of all. A
/// raster's name is its value, and slope(name) the length of its gradient.
class ExpressionField final : public SizeField {
 public:
  /// Values below `shortest` count as `shortest`. Throws InputError naming the column and the token where the
  /// expression is wrong, and one naming the markers that exist where distance asks for another. `spacing`: see
  /// LeastSearch. `input`: with the segments that distance measures to, needed no longer than this call; null: none.
  explicit ExpressionField(const std::string& expression, double shortest = 0,
                           double spacing = std::numeric_limits<double>::infinity(), const Pslg* input = nullptr,
                           const NamedRasters& rasters = {});
  ~ExpressionField() override;

  /// Throws InputError naming `p` if the value there is NaN or not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

  /// Whether the least values of the expression over boxes are known. If not, falls_below knows nothing either.
  [[nodiscard]] bool has_bounds() const;
  /// Holds all values over a box, whose ends may be infinite, if they are known.
  [[nodiscard]] Interval range(const Box& box) const;
  /// The value at a point, not below the shortest length: not a length if it is not positive or NaN.
  [[nodiscard]] double value(const Point& p) const;
  [[nodiscard]] double least() const override;
  [[nodiscard]] double least_near(const std::array<Point, 3>& triangle) const override;
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;

 private:
  struct Parser;
  struct Bounds;
  std::unique_ptr<Parser> parser_;
  double shortest_;
  std::unique_ptr<Bounds> bounds_;  // null: unknown
};

}  // namespace driftmesh
