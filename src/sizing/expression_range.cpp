#include "sizing/expression_range.hpp"

#include <array>
#include <utility>

#include "sizing/expression_compiler.hpp"

namespace driftmesh {
namespace {

using Op = ExpressionOp;

/// What is on the stack after all steps, with the values of those that take nothing from it.
template <class Value, class Constant, class Variable>
Value run(const std::vector<ExpressionStep>& steps, const Value& x, const Value& y, const Constant& constant,
          const Variable& variable) {
  std::array<Value, kDeepestExpression> stack;
  std::size_t size = 0;
  for (const ExpressionStep& step : steps) {
    size -= operands_of(step.op);
    switch (step.op) {
      case Op::kX:
        stack[size] = x;
        break;
      case Op::kY:
        stack[size] = y;
        break;
      case Op::kConstant:
        stack[size] = constant(step);
        break;
      case Op::kVariable:
        stack[size] = variable(step);
        break;
      default:
        stack[size] = apply(step.op, &stack[size]);
    }
    ++size;
  }
  return stack[0];
}

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
  return run<Interval>(
      steps_, {box.low.x, box.high.x}, {box.low.y, box.high.y}, [](const ExpressionStep& s) { return s.constant; },
      [&](const ExpressionStep& s) { return function_of(s).over(box); });
}

double ExpressionRange::at(const Point& p) const {
  return run<double>(
      steps_, p.x, p.y, [](const ExpressionStep& s) { return s.constant.low; },
      [&](const ExpressionStep& s) { return function_of(s).at(p); });
}

}  // namespace driftmesh
