#pragma once

#include <array>
#include <limits>
#include <string>

#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "sizing/expression.hpp"
#include "sizing/interval.hpp"
#include "sizing/least_search.hpp"
#include "sizing/named_raster.hpp"

namespace driftmesh {

/// The target edge length as an expression in x and y, for example "0.01 + 0.2*sqrt(x^2 + y^2)": see
/// docs/size-expressions.md.
class ExpressionField final : public SizeField {
 public:
  /// Values below `shortest` count as `shortest`. `spacing`: see LeastSearch. The others, and errors: see
  /// parse_expression.
  explicit ExpressionField(const std::string& expression, double shortest = 0,
                           double spacing = std::numeric_limits<double>::infinity(), const Pslg* input = nullptr,
                           const NamedRasters& rasters = {});

  /// Throws InputError naming `p` if the value there is NaN or not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

  /// Holds all values over a box, whose ends may be infinite.
  [[nodiscard]] Interval range(const Box& box) const;
  /// The value at a point, not below the shortest length: not a length if it is not positive or NaN.
  [[nodiscard]] double value(const Point& p) const;
  [[nodiscard]] double least() const override;
  [[nodiscard]] double least_near(const std::array<Point, 3>& triangle) const override;
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;

 private:
  std::string text_;
  Expression expression_;
  double shortest_;
  mutable LeastSearch search_;
};

}  // namespace driftmesh
