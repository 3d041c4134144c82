#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/box.hpp"
#include "sizing/expression_step.hpp"
#include "sizing/interval.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The values that an expression in x and y can take over a box, by interval arithmetic (Moore, "Interval Analysis",
/// 1966). They are never underestimated. They are exact but for rounding if x and y appear once each, and approach the
/// exact ones as the box shrinks otherwise.
class ExpressionRange {
 public:
  /// For an expression that muParser accepts; nothing if it uses what is not known here.
  /// `variables`: those that it may contain beside x and y.
  [[nodiscard]] static std::optional<ExpressionRange> of(const std::string& expression, PlaneVariables variables = {});

  /// Infinite ends are allowed.
  [[nodiscard]] Interval over(const Box& box) const;
  /// The value at a point, NaN where the expression has none.
  [[nodiscard]] double at(const Point& p) const;

 private:
  [[nodiscard]] const PlaneFunction& function_of(const ExpressionStep& step) const;

  std::vector<ExpressionStep> steps_;
  PlaneVariables variables_;
};

}  // namespace driftmesh
