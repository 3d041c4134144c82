#include "sizing/water_waves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace driftmesh {
namespace {

using namespace intervals;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kShallow = 1e-20;  // relative depth; below, tanh(x) is x
constexpr double kShallowest = 1;   // meters, for Courant numbers

/// x of x tanh(x) = y.
double wave_number(double y) {
  constexpr double kDeep = 40;  // beyond, tanh is 1
  if (!(y < kDeep)) return y;
  if (y < kShallow) return std::sqrt(y);
  double x = y / std::sqrt(std::tanh(y));  // Eckart, 1952: off by 5 % at most
  for (int step = 0; step < 5; ++step) {
    const double t = std::tanh(x);
    x -= (x * t - y) / (t + x * (1 - t * t));
  }
  return x;
}

/// The depth times 2 pi over the length of waves in deep water.
double relative_depth(double depth, double period) {
  return kTurn * kTurn / kGravity * (depth / (period * period));
}

/// 2 x / sinh(2 x): 1 in shallow and 0 in deep water.
double shallowness(double x) {
  return x == 0 ? 1 : std::isinf(x) ? 0 : 2 * x / std::sinh(2 * x);
}

Interval root(const Interval& a) {
  return rising(static_cast<double (*)(double)>(std::sqrt), a, 0);
}

Interval celerity(const Interval& depth) {
  return root(multiply({kGravity, kGravity}, larger(depth, {kShallowest, kShallowest})));
}

}  // namespace

double wavelength(double depth, double period) {
  if (!(depth >= 0 && period >= 0)) return std::numeric_limits<double>::quiet_NaN();
  if (depth == 0 || period == 0) return 0;
  const double y = relative_depth(depth, period);
  if (y < kShallow) return period * std::sqrt(kGravity * depth);
  return kGravity / kTurn * period * period * std::tanh(wave_number(y));
}

Interval wavelength_over(const Interval& depth, const Interval& period) {
  if (depth.low < 0 || period.low < 0) return kAll;
  return outward(wavelength(depth.low, period.low), wavelength(depth.high, period.high));
}

/// With x = 2 pi h / L, dL/dh = 2 pi / (x + sinh(2 x) / 2), and dL/dT = 2 L / T / (1 + 2 x / sinh(2 x)). x rises with
/// depth and falls with the period.
Interval wavelength_slope(const Interval& depth, const Interval& period, const Interval& of_depth,
                          const Interval& of_period) {
  if (!(depth.low >= 0 && period.low > 0)) return kAll;
  constexpr double kForRounding = 1e-13;  // sinh is sensitive to it
  const double low = (1 - kForRounding) * wave_number(relative_depth(depth.low, period.high));
  const double high = (1 + kForRounding) * wave_number(relative_depth(depth.high, period.low));
  const auto by_depth = [](double x) { return kTurn / (x + std::sinh(2 * x) / 2); };
  const Interval in_depth = outward(by_depth(high), by_depth(low));
  const Interval speed = divide(wavelength_over(depth, period), period);
  const Interval in_period = multiply({2, 2}, divide(speed, add({1, 1}, outward(shallowness(high), shallowness(low)))));
  return add(multiply(in_depth, of_depth), multiply(in_period, of_period));
}

double courant_length(double depth, double dt, double bound, double speed) {
  return dt * (std::sqrt(kGravity * std::max(depth, kShallowest)) + speed) / bound;
}

Interval courant_length_over(const Interval* v) {
  return divide(multiply(v[1], add(celerity(v[0]), v[3])), v[2]);
}

Interval courant_length_slope(const Interval* v, const Interval* d) {
  const Interval wave = celerity(v[0]), speed = add(wave, v[3]);
  const Interval of_depth = v[0].high <= kShallowest ? Interval{0, 0}
                            : v[0].low < kShallowest ? hull({0, 0}, d[0])
                                                     : d[0];
  const Interval of_speed = add(multiply(divide({kGravity / 2, kGravity / 2}, wave), of_depth), d[3]);
  const Interval product = multiply(v[1], speed), of_product = add(multiply(d[1], speed), multiply(v[1], of_speed));
  const Interval quotient = divide(product, v[2]);
  return quotient == kAll ? kAll : divide(subtract(of_product, multiply(quotient, d[2])), v[2]);
}

}  // namespace driftmesh
