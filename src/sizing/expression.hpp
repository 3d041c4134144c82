#pragma once

#include <string>
#include <vector>

#include "geometry/box.hpp"
#include "sizing/expression_parser.hpp"
#include "sizing/interval.hpp"

namespace driftmesh {

/// A formula in x and y, and in what can be measured at a point: docs/size-expressions.md. Queries depend on their
/// arguments alone, and may run in several threads at once.
class Expression {
 public:
  /// Throws InputError: see parse_expression.
  explicit Expression(const std::string& text, const Pslg* input = nullptr, const NamedRasters& rasters = {})
      : steps_(parse_expression(text, input, rasters)) {}

  /// The value at a point, NaN where the expression has none.
  [[nodiscard]] double at(const Point& p) const;
  /// Holds the values at all points of a box, whose ends may be infinite, by interval arithmetic (Moore, "Interval
  /// Analysis", 1966). Exact but for rounding if x and y appear once each; approaches the exact ones as the box shrinks
  /// otherwise.
  [[nodiscard]] Interval over(const Box& box) const;

 private:
  std::vector<ExpressionStep> steps_;
};

}  // namespace driftmesh
