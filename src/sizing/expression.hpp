#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sizing/expression_parser.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// A formula in x and y, and in what can be measured at a point: docs/size-expressions.md.
class Expression final : public PlaneFunction {
 public:
  /// Throws InputError: see parse_expression.
  explicit Expression(const std::string& text, const Pslg* input = nullptr, const NamedRasters& rasters = {},
                      const FindOutline& outline = {})
      : Expression(parse_expression(text, input, rasters, outline)) {}

  /// The value at a point, NaN where the expression has none.
  [[nodiscard]] double at(const Point& p) const override;
  /// By interval arithmetic (Moore, "Interval Analysis", 1966), for slopes through the chain rule. Values are exact but
  /// for rounding if x and y appear once each; all bounds approach the exact ones as the box shrinks otherwise.
  [[nodiscard]] Variation over(const Box& box) const override;
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;

 private:
  using Functions = std::vector<std::shared_ptr<const PlaneFunction>>;
  explicit Expression(ParsedExpression parsed)
      : steps_(std::make_shared<const std::vector<ExpressionStep>>(std::move(parsed.steps))),
        functions_(std::move(parsed.functions)) {}

  std::shared_ptr<const std::vector<ExpressionStep>> steps_;
  Functions functions_;
};

}  // namespace driftmesh
