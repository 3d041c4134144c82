#include "sizing/expression.hpp"

#include <array>

namespace driftmesh {
namespace {

using Functions = std::vector<std::shared_ptr<const PlaneFunction>>;

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
  using Value = Variation;
  static constexpr Interval kNone{0, 0}, kOne{1, 1}, kUpToOne{-1, 1};
  const Box& box;

  [[nodiscard]] Variation x() const { return {{box.low.x, box.high.x}, kOne, kNone, kUpToOne}; }
  [[nodiscard]] Variation y() const { return {{box.low.y, box.high.y}, kNone, kOne, kUpToOne}; }
  [[nodiscard]] static Variation constant(double value) { return {{value, value}, kNone, kNone, kNone}; }
  [[nodiscard]] Variation of(const PlaneFunction& function) const { return function.over(box); }
  [[nodiscard]] static Variation of(const Operation& operation, const Variation* v) { return operation.over(v); }
};

/// What is on the stack after all steps.
template <class Place>
typename Place::Value run(const std::vector<ExpressionStep>& steps, const Functions& functions, const Place& place) {
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
      *top = place.of(*functions[step.function]);
    } else {
      *top = step.leaf == kX ? place.x() : place.y();
    }
    ++top;
  }
  return stack[0];
}

}  // namespace

double Expression::at(const Point& p) const {
  return run(*steps_, functions_, AtPoint{p});
}

Variation Expression::over(const Box& box) const {
  return run(*steps_, functions_, OverBox{box});
}

std::shared_ptr<const PlaneFunction> Expression::within(const Box& box) const {
  std::shared_ptr<Expression> narrowed;
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    auto function = functions_[k]->within(box);
    if (function == nullptr) continue;
    if (narrowed == nullptr) narrowed = std::make_shared<Expression>(*this);
    narrowed->functions_[k] = std::move(function);
  }
  return narrowed;
}

}  // namespace driftmesh
