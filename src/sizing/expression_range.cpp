#include "sizing/expression_range.hpp"

#include <array>
#include <utility>

#include "sizing/expression_compiler.hpp"

namespace driftmesh {
namespace {

using Op = ExpressionOp;

}  // namespace

std::optional<ExpressionRange> ExpressionRange::of(const std::string& expression, PlaneVariables variables) {
  auto steps = compile_expression(expression, variables);
  if (!steps) return std::nullopt;
  ExpressionRange range;
  range.steps_ = std::move(*steps);
  range.variables_ = std::move(variables);
  return range;
}

const PlaneFunction& ExpressionRange::function_of(const ExpressionStep& step) const {
  return *variables_[static_cast<std::size_t>(step.constant.low)].function;
}

Interval ExpressionRange::over(const Box& box) const {
  std::array<Interval, kDeepestExpression> stack;
  std::size_t size = 0;
  for (const ExpressionStep& step : steps_) {
    size -= operands_of(step.op);
    switch (step.op) {
      case Op::kX:
        stack[size] = {box.low.x, box.high.x};
        break;
      case Op::kY:
        stack[size] = {box.low.y, box.high.y};
        break;
      case Op::kConstant:
        stack[size] = step.constant;
        break;
      case Op::kVariable:
        stack[size] = function_of(step).over(box);
        break;
      default:
        stack[size] = apply(step.op, &stack[size]);
    }
    ++size;
  }
  return stack[0];
}

double ExpressionRange::at(const Point& p) const {
  std::array<double, kDeepestExpression> stack;
  std::size_t size = 0;
  for (const ExpressionStep& step : steps_) {
    size -= operands_of(step.op);
    switch (step.op) {
      case Op::kX:
        stack[size] = p.x;
        break;
      case Op::kY:
        stack[size] = p.y;
        break;
      case Op::kConstant:
        stack[size] = step.constant.low;
        break;
      case Op::kVariable:
        stack[size] = function_of(step).at(p);
        break;
      default:
        stack[size] = apply(step.op, &stack[size]);
    }
    ++size;
  }
  return stack[0];
}

}  // namespace driftmesh
