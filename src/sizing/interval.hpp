#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace driftmesh {

/// All numbers from low to high, for the values of an expression over a box. Results of operations hold every value
/// that the operation takes on its operands in double precision: their ends are moved outward by more than rounding
/// errors, those of the mathematical functions included. Where an operation may be undefined, its result is kAll.
struct Interval {
  double low, high;
  bool undefined;  ///< whether the value may also be NaN, with which every comparison fails

  Interval() = default;  // leaves them unset
  constexpr Interval(double least, double most, bool or_nan = false) : low(least), high(most), undefined(or_nan) {}

  [[nodiscard]] bool is_point() const { return low == high; }
  [[nodiscard]] bool holds(double value) const { return low <= value && value <= high; }
  bool operator==(const Interval&) const = default;
};

namespace intervals {

inline constexpr Interval kAll{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
inline constexpr Interval kYes{1, 1}, kNo{0, 0}, kMaybe{0, 1};

/// With the ends moved outward, by 16 units in the last place, and to numbers where both overflowed on one side: what
/// is computed in another order need not overflow.
[[nodiscard]] inline Interval outward(double low, double high) {
  constexpr double kMore = 1 + 0x1p-48, kLess = 1 - 0x1p-48, kTiny = 0x1p-1060;
  constexpr double kMost = std::numeric_limits<double>::max();
  if (std::isnan(low) || std::isnan(high)) return kAll;
  low = std::min(low, kMost);
  high = std::max(high, -kMost);
  const double down = low > 0 ? low * kLess : low * kMore, up = high > 0 ? high * kMore : high * kLess;
  return {low == 0 ? 0 : down - kTiny, high == 0 ? 0 : up + kTiny};
}

[[nodiscard]] inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high), a.undefined || b.undefined};
}

[[nodiscard]] inline Interval add(const Interval& a, const Interval& b) {
  return outward(a.low + b.low, a.high + b.high);
}

[[nodiscard]] inline Interval negative(const Interval& a) {
  return {-a.high, -a.low};
}

[[nodiscard]] inline Interval subtract(const Interval& a, const Interval& b) {
  return add(a, negative(b));
}

[[nodiscard]] inline Interval multiply(const Interval& a, const Interval& b) {
  const auto product = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };  // also 0 * infinity
  const auto [low, high] =
      std::minmax({product(a.low, b.low), product(a.low, b.high), product(a.high, b.low), product(a.high, b.high)});
  return outward(low, high);
}

[[nodiscard]] inline Interval divide(const Interval& a, const Interval& b) {
  if (b.holds(0)) return kAll;  // 0 may be -0, and the quotient -infinity
  return multiply(a, outward(1 / b.high, 1 / b.low));
}

/// A function that never falls.
template <class Function>
[[nodiscard]] Interval rising(const Function& f, const Interval& a) {
  return outward(f(a.low), f(a.high));
}

/// The same, defined from `least` to `most` alone.
template <class Function>
[[nodiscard]] Interval rising(const Function& f, const Interval& a, double least,
                              double most = std::numeric_limits<double>::infinity()) {
  return a.low < least || a.high > most ? kAll : rising(f, a);
}

[[nodiscard]] inline Interval absolute(const Interval& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return negative(a);
  return {0, std::max(-a.low, a.high)};
}

[[nodiscard]] inline Interval square(const Interval& a) {
  return rising([](double x) { return x * x; }, absolute(a));
}

[[nodiscard]] inline Interval whole_power(const Interval& a, double n) {
  const auto power = [n](double x) { return std::pow(x, n); };
  if (n < 0) return divide({1, 1}, whole_power(a, -n));
  const bool even = std::fmod(n, 2) == 0;
  return rising(power, even ? absolute(a) : a);
}

[[nodiscard]] inline Interval power(const Interval& a, const Interval& b) {
  if (b.is_point() && std::isfinite(b.low) && b.low == std::floor(b.low)) return whole_power(a, b.low);
  if (a.low < 0 || (a.low == 0 && b.low <= 0)) return kAll;
  // Monotone in each of the two, so its extremes are at corners.
  const auto [low, high] =
      std::minmax({std::pow(a.low, b.low), std::pow(a.low, b.high), std::pow(a.high, b.low), std::pow(a.high, b.high)});
  return outward(low, high);
}

/// The sine, `turn` radians ahead.
[[nodiscard]] inline Interval turned_sine(const Interval& a, double turn) {
  constexpr double kFar = 1e6;  // beyond, the periods below are not exact enough
  if (!(a.low > -kFar && a.high < kFar)) return {-1, 1};
  constexpr double kPeriod = 2 * std::numbers::pi, kSlack = 1e-9;
  const auto passes = [&](double extreme) {  // whether an angle of this one modulo 2 pi is in the interval
    return std::floor((a.high + turn - extreme + kSlack) / kPeriod) >=
           std::ceil((a.low + turn - extreme - kSlack) / kPeriod);
  };
  const double at_low = std::sin(a.low + turn), at_high = std::sin(a.high + turn);
  constexpr double kError = 1e-9;  // error of the sum at this distance
  return {passes(-std::numbers::pi / 2) ? -1 : std::max(-1.0, std::min(at_low, at_high) - kError),
          passes(std::numbers::pi / 2) ? 1 : std::min(1.0, std::max(at_low, at_high) + kError)};
}

[[nodiscard]] inline Interval sine(const Interval& a) {
  return turned_sine(a, 0);
}

[[nodiscard]] inline Interval cosine(const Interval& a) {
  return turned_sine(a, std::numbers::pi / 2);
}

[[nodiscard]] inline Interval tangent(const Interval& a) {
  return divide(sine(a), cosine(a));
}

[[nodiscard]] inline Interval angle(const Interval& y, const Interval& x) {
  if (x.low <= 0 && y.low <= 0 && y.high >= 0) return outward(-std::numbers::pi, std::numbers::pi);
  const auto [low, high] = std::minmax(
      {std::atan2(y.low, x.low), std::atan2(y.low, x.high), std::atan2(y.high, x.low), std::atan2(y.high, x.high)});
  return outward(low, high);
}

[[nodiscard]] inline Interval length(const Interval& a, const Interval& b) {
  const Interval x = absolute(a), y = absolute(b);
  return outward(std::hypot(x.low, y.low), std::hypot(x.high, y.high));
}

/// The first of two, where one of them is NaN.
[[nodiscard]] inline Interval smaller(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), b.undefined ? a.high : std::min(a.high, b.high), a.undefined};
}

/// The same.
[[nodiscard]] inline Interval larger(const Interval& a, const Interval& b) {
  return {b.undefined ? a.low : std::max(a.low, b.low), std::max(a.high, b.high), a.undefined};
}

[[nodiscard]] inline Interval truth(bool surely, bool surely_not) {
  return surely ? kYes : surely_not ? kNo : kMaybe;
}

[[nodiscard]] inline Interval less(const Interval& a, const Interval& b) {
  return truth(a.high < b.low, a.low >= b.high);
}

[[nodiscard]] inline Interval at_most(const Interval& a, const Interval& b) {
  return truth(a.high <= b.low, a.low > b.high);
}

[[nodiscard]] inline Interval equal(const Interval& a, const Interval& b) {
  return truth(a.is_point() && a == b, a.high < b.low || b.high < a.low);
}

/// As a condition: whatever is not 0 is true.
[[nodiscard]] inline Interval condition(const Interval& a) {
  return a.undefined ? kMaybe : truth(!a.holds(0), a == kNo);
}

[[nodiscard]] inline Interval opposite(const Interval& a) {
  return {1 - a.high, 1 - a.low};
}

[[nodiscard]] inline Interval both(const Interval& a, const Interval& b) {
  return smaller(condition(a), condition(b));
}

[[nodiscard]] inline Interval either(const Interval& a, const Interval& b) {
  return larger(condition(a), condition(b));
}

[[nodiscard]] inline Interval choose(const Interval& a, const Interval& then, const Interval& otherwise) {
  const Interval c = condition(a);
  return c == kYes ? then : c == kNo ? otherwise : hull(then, otherwise);
}

}  // namespace intervals
}  // namespace driftmesh
