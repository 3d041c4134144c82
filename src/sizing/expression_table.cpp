#include "sizing/expression_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "sizing/water_waves.hpp"

namespace driftmesh {
namespace {

using namespace intervals;
using enum Operation::Result;
using enum Function::Arguments;
using V = const double*;
using R = const Interval*;

template <double (*f)(double)>
double of1(V v) {
  return f(v[0]);
}
template <auto f>
double of2(V v) {
  return f(v[0], v[1]);
}
template <Interval (*f)(const Interval&)>
Interval over1(R v) {
  return f(v[0]);
}
template <Interval (*f)(const Interval&, const Interval&)>
Interval over2(R v) {
  return f(v[0], v[1]);
}

/// Functions that never fall.
template <double (*f)(double)>
Interval rising_over(R v) {
  return rising(f, v[0]);
}
template <double (*f)(double), int kLeast>
Interval rising_from(R v) {
  return rising(f, v[0], kLeast);
}
template <double (*f)(double), int kLeast, int kMost>
Interval rising_between(R v) {
  return rising(f, v[0], kLeast, kMost);
}

double negative_acos(double a) {
  return -std::acos(a);
}
double sign(double a) {
  return (a > 0) - (a < 0);
}
double rounded(double a) {
  return std::floor(a + 0.5);
}
Interval acos_over(R v) {
  return negative(rising(negative_acos, v[0], -1, 1));
}
Interval cosh_over(R v) {
  return rising(static_cast<double (*)(double)>(std::cosh), absolute(v[0]));
}
Interval sign_over(R v) {
  return v[0].undefined ? Interval{-1, 1} : rising(sign, v[0]);  // 0 for NaN
}
constexpr auto kPower = [](double a, double b) { return std::pow(a, b); };
constexpr auto kAngle = [](double y, double x) { return std::atan2(y, x); };
constexpr auto kLength = [](double a, double b) { return std::hypot(a, b); };
constexpr auto kMin = [](double a, double b) { return std::min(a, b); };
constexpr auto kMax = [](double a, double b) { return std::max(a, b); };

// ---- Slopes ----

/// Of f(a), where these are the slopes of f over a.
template <Interval (*f)(const Interval&)>
Interval chain(R v, R d) {
  return multiply(f(v[0]), d[0]);
}

Interval add_slope(R, R d) {
  return add(d[0], d[1]);
}
Interval subtract_slope(R, R d) {
  return subtract(d[0], d[1]);
}
Interval multiply_slope(R v, R d) {
  return add(multiply(v[0], d[1]), multiply(v[1], d[0]));
}
Interval divide_slope(R v, R d) {
  const Interval quotient = divide(v[0], v[1]);
  return quotient == kAll ? kAll : divide(subtract(d[0], multiply(quotient, d[1])), v[1]);
}
Interval power_slope(R v, R d) {
  if (!v[1].is_point()) return kAll;
  return multiply(multiply(v[1], power(v[0], {v[1].low - 1, v[1].low - 1})), d[0]);
}
Interval negative_slope(R, R d) {
  return negative(d[0]);
}
Interval absolute_slope(R v, R d) {
  return v[0].low >= 0 ? d[0] : v[0].high <= 0 ? negative(d[0]) : hull(d[0], negative(d[0]));
}
Interval twice(const Interval& a) {
  return multiply({2, 2}, a);
}
Interval over_twice_root(const Interval& a) {
  return divide({0.5, 0.5}, rising(static_cast<double (*)(double)>(std::sqrt), a, 0));
}
Interval exponential(const Interval& a) {
  return rising(static_cast<double (*)(double)>(std::exp), a);
}
template <int kBase>
Interval over_logarithm(const Interval& a) {
  const double scale = kBase == 0 ? 1 : 1 / std::log(static_cast<double>(kBase));
  return divide({scale, scale}, a);
}
Interval negative_sine(const Interval& a) {
  return negative(sine(a));
}
Interval over_square_and_one(const Interval& a) {
  return divide({1, 1}, add({1, 1}, square(a)));
}
Interval hyperbolic_slope(const Interval& a) {
  return subtract({1, 1}, square(rising(static_cast<double (*)(double)>(std::tanh), a)));
}
/// Of a / hypot(a, b), which rises with a.
Interval share(const Interval& a, const Interval& b) {
  const Interval other = absolute(b);
  const auto at = [](double x, double y) {
    return x == 0 ? 0 : std::isinf(x) ? (x > 0 ? 1 : -1) : x / std::hypot(x, y);
  };
  const Interval found =
      outward(at(a.low, a.low > 0 ? other.high : other.low), at(a.high, a.high > 0 ? other.low : other.high));
  return {std::max(found.low, -1.0), std::min(found.high, 1.0)};
}
Interval length_slope(R v, R d) {
  return add(multiply(share(v[0], v[1]), d[0]), multiply(share(v[1], v[0]), d[1]));
}
/// Where one may be NaN, the result may jump to the other.
Interval smaller_slope(R v, R d) {
  if (v[0].undefined || v[1].undefined) return kAll;
  return v[0].high <= v[1].low ? d[0] : v[1].high < v[0].low ? d[1] : hull(d[0], d[1]);
}
Interval larger_slope(R v, R d) {
  if (v[0].undefined || v[1].undefined) return kAll;
  return v[0].low >= v[1].high ? d[0] : v[1].low > v[0].high ? d[1] : hull(d[0], d[1]);
}
Interval choose_slope(R v, R d) {
  const Interval c = condition(v[0]);
  return c == kYes ? d[1] : c == kNo ? d[2] : kAll;
}

constexpr std::array kOperators{
    Operator{"||", 1, {2, of2<std::logical_or<>{}>, over2<either>, nullptr, kTruth}},
    Operator{"&&", 2, {2, of2<std::logical_and<>{}>, over2<both>, nullptr, kTruth}},
    Operator{"<=", 3, {2, of2<std::less_equal<>{}>, over2<at_most>, nullptr, kTruth}},
    Operator{">=", 3, {2, of2<std::greater_equal<>{}>, [](R v) { return at_most(v[1], v[0]); }, nullptr, kTruth}},
    Operator{"==", 3, {2, of2<std::equal_to<>{}>, over2<equal>, nullptr, kTruth}},
    Operator{
        "!=", 3, {2, of2<std::not_equal_to<>{}>, [](R v) { return opposite(equal(v[0], v[1])); }, nullptr, kTruth}},
    Operator{"<", 3, {2, of2<std::less<>{}>, over2<less>, nullptr, kTruth}},
    Operator{">", 3, {2, of2<std::greater<>{}>, [](R v) { return less(v[1], v[0]); }, nullptr, kTruth}},
    Operator{"+", 4, {2, of2<std::plus<>{}>, over2<add>, add_slope}},
    Operator{"-", 4, {2, of2<std::minus<>{}>, over2<subtract>, subtract_slope}},
    Operator{"*", 5, {2, of2<std::multiplies<>{}>, over2<multiply>, multiply_slope}},
    Operator{"/", 5, {2, of2<std::divides<>{}>, over2<divide>, divide_slope}},
    Operator{"^", 6, {2, of2<kPower>, over2<power>, power_slope}},
};

constexpr std::array kCourantDefaults{0.5, 0.0};

constexpr std::array kFunctions{
    Function{"abs", "a", "absolute value", {1, of1<std::fabs>, over1<absolute>, absolute_slope}},
    Function{"sign", "a", "-1, 0 or 1, as a is negative, 0 (or NaN) or positive", {1, of1<sign>, sign_over}},
    Function{"rint", "a", "the nearest whole number, from halves the greater", {1, of1<rounded>, rising_over<rounded>}},
    Function{"sqrt",
             "a",
             "square root; NaN below 0",
             {1, of1<std::sqrt>, rising_from<std::sqrt, 0>, chain<over_twice_root>}},
    Function{"exp", "a", "e^a", {1, of1<std::exp>, rising_over<std::exp>, chain<exponential>}},
    Function{"ln",
             "a",
             "natural logarithm; NaN below 0",
             {1, of1<std::log>, rising_from<std::log, 0>, chain<over_logarithm<0>>}},
    Function{"log", "a", "the same as ln", {1, of1<std::log>, rising_from<std::log, 0>, chain<over_logarithm<0>>}},
    Function{
        "log2", "a", "logarithm to base 2", {1, of1<std::log2>, rising_from<std::log2, 0>, chain<over_logarithm<2>>}},
    Function{"log10",
             "a",
             "logarithm to base 10",
             {1, of1<std::log10>, rising_from<std::log10, 0>, chain<over_logarithm<10>>}},
    Function{"sin", "a", "sine of an angle in radians", {1, of1<std::sin>, over1<sine>, chain<cosine>}},
    Function{"cos", "a", "cosine", {1, of1<std::cos>, over1<cosine>, chain<negative_sine>}},
    Function{"tan", "a", "tangent", {1, of1<std::tan>, over1<tangent>}},
    Function{"asin", "a", "arc sine; NaN beyond -1 and 1", {1, of1<std::asin>, rising_between<std::asin, -1, 1>}},
    Function{"acos", "a", "arc cosine; NaN beyond -1 and 1", {1, of1<std::acos>, acos_over}},
    Function{"atan", "a", "arc tangent", {1, of1<std::atan>, rising_over<std::atan>, chain<over_square_and_one>}},
    Function{"atan2", "a, b", "angle of the vector (b, a), from -pi to pi", {2, of2<kAngle>, over2<angle>}},
    Function{"sinh", "a", "hyperbolic sine", {1, of1<std::sinh>, rising_over<std::sinh>}},
    Function{"cosh", "a", "hyperbolic cosine", {1, of1<std::cosh>, cosh_over}},
    Function{"tanh", "a", "hyperbolic tangent", {1, of1<std::tanh>, rising_over<std::tanh>, chain<hyperbolic_slope>}},
    Function{"asinh", "a", "inverse of sinh", {1, of1<std::asinh>, rising_over<std::asinh>}},
    Function{"acosh", "a", "inverse of cosh; NaN below 1", {1, of1<std::acosh>, rising_from<std::acosh, 1>}},
    Function{
        "atanh", "a", "inverse of tanh; NaN beyond -1 and 1", {1, of1<std::atanh>, rising_between<std::atanh, -1, 1>}},
    Function{"hypot", "a, b", "length of the vector (a, b)", {2, of2<kLength>, over2<length>, length_slope}},
    Function{"min", "a, b, ...", "the smallest", {2, of2<kMin>, over2<smaller>, smaller_slope, kOperand}, kAny},
    Function{"max", "a, b, ...", "the greatest", {2, of2<kMax>, over2<larger>, larger_slope, kOperand}, kAny},
    Function{"sum", "a, b, ...", "the sum", {2, of2<std::plus<>{}>, over2<add>, add_slope}, kAny},
    Function{"avg", "a, b, ...", "the mean", {2, of2<std::plus<>{}>, over2<add>, add_slope}, kAnyForMean},
    Function{"wavelength",
             "depth, period",
             "length of water waves (m) of a period (s) in a depth (m); NaN where one is negative",
             {2, of2<wavelength>, over2<wavelength_over>,
              [](R v, R d) { return wavelength_slope(v[0], v[1], d[0], d[1]); }}},
    Function{"courant",
             "depth, dt, bound = 0.5, speed = 0",
             "edge length (m) at which waves in a depth (m) have this Courant number in steps of dt (s)",
             {4, [](V v) { return courant_length(v[0], v[1], v[2], v[3]); }, courant_length_over, courant_length_slope},
             kFixed,
             kCourantDefaults},
};

constexpr std::array kConstants{NamedConstant{"pi", std::numbers::pi}, NamedConstant{"e", std::numbers::e},
                                NamedConstant{"_pi", std::numbers::pi}, NamedConstant{"_e", std::numbers::e}};

}  // namespace

const Operation kNegative{1, [](V v) { return -v[0]; }, over1<negative>, negative_slope};
const Operation kSquare{1, [](V v) { return v[0] * v[0]; }, over1<square>, chain<twice>};
const Operation kChoose{3, [](V v) { return v[0] != 0 ? v[1] : v[2]; }, [](R v) { return choose(v[0], v[1], v[2]); },
                        choose_slope, kOperand};

std::span<const Operator> expression_operators() {
  return kOperators;
}

std::span<const Function> expression_functions() {
  return kFunctions;
}

std::span<const NamedConstant> expression_constants() {
  return kConstants;
}

namespace {

Interval values_over(const Operation& operation, R v) {
  Interval found = operation.range(v);
  if (operation.result == kOperand) return found;
  const std::span all(v, static_cast<std::size_t>(operation.operands));
  const bool of_undefined = std::ranges::any_of(all, &Interval::undefined);
  if (operation.result == kTruth) return of_undefined ? kMaybe : found;
  // Infinities can become NaN in any.
  const auto may_be_infinite = [](const Interval& a) { return std::isinf(a.low) || std::isinf(a.high); };
  found.undefined = of_undefined || found == kAll || std::ranges::any_of(all, may_be_infinite);
  return found;
}

}  // namespace

Variation Operation::over(const Variation* v) const {
  std::array<Interval, kMostOperands> values, slopes;
  const auto of = [&](Interval Variation::*which, auto& all) {
    for (int k = 0; k < operands; ++k) all[static_cast<std::size_t>(k)] = v[k].*which;
  };
  of(&Variation::value, values);
  const Interval found = values_over(*this, values.data());
  if (found.is_point() && !found.undefined) return {found, {0, 0}, {0, 0}, {0, 0}};
  const auto slope_of = [&](Interval Variation::*which) {
    if (slope == nullptr || found.undefined) return kAll;
    of(which, slopes);
    return slope(values.data(), slopes.data());
  };
  return {found, slope_of(&Variation::in_x), slope_of(&Variation::in_y), slope_of(&Variation::in_directions)};
}

std::string expression_functions_table() {
  std::string table = "| function | value |\n|---|---|\n";
  for (const Function& f : kFunctions)
    table.append("| `").append(f.name).append("(").append(f.arguments).append(")` | ").append(f.meaning).append(" |\n");
  return table;
}

}  // namespace driftmesh
