#include "sizing/expression.hpp"

#include <array>

namespace driftmesh {
namespace {

struct AtPoint {
  using Value = double;
  const Point& p;

  [[nodiscard]] double x() const { return p.x; }
  [[nodiscard]] double y() const { return p.y; }
  [[nodiscard]] static double constant(double value) { return value; }
  [[nodiscard]] double of(const PlaneFunction& function) const { return function.at(p); }
  [[nodiscard]] static double of(const Operation& operation, const double* v) { return operation.value(v); }
};

struct OverBox {
  using Value = Interval;
  const Box& box;

  [[nodiscard]] Interval x() const { return {box.low.x, box.high.x}; }
  [[nodiscard]] Interval y() const { return {box.low.y, box.high.y}; }
  [[nodiscard]] static Interval constant(double value) { return {value, value}; }
  [[nodiscard]] Interval of(const PlaneFunction& function) const { return function.over(box); }
  [[nodiscard]] static Interval of(const Operation& operation, const Interval* v) { return operation.over(v); }
};

/// What is on the stack after all steps.
template <class Place>
typename Place::Value run(const std::vector<ExpressionStep>& steps, const Place& place) {
  using enum ExpressionStep::Leaf;
  std::array<typename Place::Value, kDeepestExpression> stack;
  auto* top = stack.data();
  for (const ExpressionStep& step : steps) {
    if (step.operation != nullptr) {
      top -= step.operation->operands;
      *top = place.of(*step.operation, top);
    } else if (step.leaf == kConstant) {
      *top = place.constant(step.constant);
    } else if (step.leaf == kFunction) {
      *top = place.of(*step.function);
    } else {
      *top = step.leaf == kX ? place.x() : place.y();
    }
    ++top;
  }
  return stack[0];
}

}  // namespace

double Expression::at(const Point& p) const {
  return run(steps_, AtPoint{p});
}

Interval Expression::over(const Box& box) const {
  return run(steps_, OverBox{box});
}

}  // namespace driftmesh
