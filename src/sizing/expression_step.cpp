#include "sizing/expression_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace driftmesh {
namespace {

using Op = ExpressionOp;

/// The result of an operation on values that are numbers.
Interval apply_to_numbers(Op op, const Interval* v) {
  using namespace intervals;
  constexpr auto kReal = [](double (*f)(double)) { return f; };  // of the overloads, the one of doubles
  switch (op) {
    case Op::kNegative:
      return negative(v[0]);
    case Op::kSquare:
      return square(v[0]);
    case Op::kSin:
      return sine(v[0]);
    case Op::kCos:
      return cosine(v[0]);
    case Op::kTan:
      return tangent(v[0]);
    case Op::kAsin:
      return rising(kReal(std::asin), v[0], -1, 1);
    case Op::kAcos:
      return negative(rising([](double x) { return -std::acos(x); }, v[0], -1, 1));
    case Op::kAtan:
      return rising(kReal(std::atan), v[0]);
    case Op::kSinh:
      return rising(kReal(std::sinh), v[0]);
    case Op::kCosh:
      return rising(kReal(std::cosh), absolute(v[0]));
    case Op::kTanh:
      return rising(kReal(std::tanh), v[0]);
    case Op::kLog2:
      return rising(kReal(std::log2), v[0], 0);
    case Op::kLog10:
      return rising(kReal(std::log10), v[0], 0);
    case Op::kLog:
      return rising(kReal(std::log), v[0], 0);
    case Op::kExp:
      return rising(kReal(std::exp), v[0]);
    case Op::kSqrt:
      return rising(kReal(std::sqrt), v[0], 0);
    case Op::kSign:
      return rising([](double x) { return static_cast<double>((x > 0) - (x < 0)); }, v[0]);
    case Op::kRint:
      return rising([](double x) { return std::floor(x + 0.5); }, v[0]);
    case Op::kAbs:
      return absolute(v[0]);
    case Op::kAdd:
      return add(v[0], v[1]);
    case Op::kSubtract:
      return subtract(v[0], v[1]);
    case Op::kMultiply:
      return multiply(v[0], v[1]);
    case Op::kDivide:
      return divide(v[0], v[1]);
    case Op::kPower:
      return power(v[0], v[1]);
    case Op::kLess:
      return less(v[0], v[1]);
    case Op::kAtMost:
      return at_most(v[0], v[1]);
    case Op::kGreater:
      return less(v[1], v[0]);
    case Op::kAtLeast:
      return at_most(v[1], v[0]);
    case Op::kEqual:
      return equal(v[0], v[1]);
    case Op::kDifferent:
      return opposite(equal(v[0], v[1]));
    case Op::kAnd:
      return both(v[0], v[1]);
    case Op::kOr:
      return either(v[0], v[1]);
    case Op::kMin:
      return smaller(v[0], v[1]);
    case Op::kMax:
      return larger(v[0], v[1]);
    case Op::kAtan2:
      return angle(v[0], v[1]);
    case Op::kHypot:
      return length(v[0], v[1]);
    case Op::kChoose:
      return choose(v[0], v[1], v[2]);
    default:
      return kAll;
  }
}

}  // namespace

std::size_t operands_of(Op op) {
  if (op < Op::kNegative) return 0;
  if (op < Op::kAdd) return 1;
  return op < Op::kChoose ? 2 : 3;
}

double apply(Op op, const double* v) {
  switch (op) {
    case Op::kNegative:
      return -v[0];
    case Op::kSquare:
      return v[0] * v[0];
    case Op::kSin:
      return std::sin(v[0]);
    case Op::kCos:
      return std::cos(v[0]);
    case Op::kTan:
      return std::tan(v[0]);
    case Op::kAsin:
      return std::asin(v[0]);
    case Op::kAcos:
      return std::acos(v[0]);
    case Op::kAtan:
      return std::atan(v[0]);
    case Op::kSinh:
      return std::sinh(v[0]);
    case Op::kCosh:
      return std::cosh(v[0]);
    case Op::kTanh:
      return std::tanh(v[0]);
    case Op::kLog2:
      return std::log2(v[0]);
    case Op::kLog10:
      return std::log10(v[0]);
    case Op::kLog:
      return std::log(v[0]);
    case Op::kExp:
      return std::exp(v[0]);
    case Op::kSqrt:
      return std::sqrt(v[0]);
    case Op::kSign:
      return (v[0] > 0) - (v[0] < 0);
    case Op::kRint:
      return std::floor(v[0] + 0.5);
    case Op::kAbs:
      return std::fabs(v[0]);
    case Op::kAdd:
      return v[0] + v[1];
    case Op::kSubtract:
      return v[0] - v[1];
    case Op::kMultiply:
      return v[0] * v[1];
    case Op::kDivide:
      return v[0] / v[1];
    case Op::kPower:
      return std::pow(v[0], v[1]);
    case Op::kLess:
      return v[0] < v[1];
    case Op::kAtMost:
      return v[0] <= v[1];
    case Op::kGreater:
      return v[0] > v[1];
    case Op::kAtLeast:
      return v[0] >= v[1];
    case Op::kEqual:
      return v[0] == v[1];
    case Op::kDifferent:
      return v[0] != v[1];
    case Op::kAnd:
      return v[0] != 0 && v[1] != 0;
    case Op::kOr:
      return v[0] != 0 || v[1] != 0;
    case Op::kMin:
      return std::min(v[0], v[1]);
    case Op::kMax:
      return std::max(v[0], v[1]);
    case Op::kAtan2:
      return std::atan2(v[0], v[1]);
    case Op::kHypot:
      return std::hypot(v[0], v[1]);
    case Op::kChoose:
      return v[0] != 0 ? v[1] : v[2];
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

Interval apply(Op op, const Interval* v) {
  Interval result = apply_to_numbers(op, v);
  if (op == Op::kChoose) return result;
  const std::span operands(v, operands_of(op));
  const auto may_be_infinite = [](const Interval& a) { return std::isinf(a.low) || std::isinf(a.high); };
  const bool of_undefined =
      std::any_of(operands.begin(), operands.end(), [](const Interval& a) { return a.undefined; });
  if (op >= Op::kLess && op <= Op::kOr) return of_undefined ? intervals::kMaybe : result;
  // An operation that may be undefined results in kAll, and infinities can become NaN in any.
  result.undefined =
      of_undefined || result == intervals::kAll || std::any_of(operands.begin(), operands.end(), may_be_infinite);
  return result;
}

}  // namespace driftmesh
