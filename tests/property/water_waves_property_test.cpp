#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>

#include "property/cases.hpp"
#include "sizing/expression.hpp"
#include "sizing/water_waves.hpp"
#include "support/check_slopes.hpp"
#include "support/infinity.hpp"
#include "support/random.hpp"

// Wavelengths against bisection of the dispersion relation, and bounds of values and slopes against differences.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

double scaled(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// The root of L - g T^2 / (2 pi) tanh(2 pi h / L), which rises with L.
long double by_bisection(long double depth, long double period) {
  constexpr long double kGravity = 9.81L, kTurn = 2 * std::numbers::pi_v<long double>;
  const long double deep = kGravity * period * period / kTurn;
  long double low = 0, high = deep;
  for (int step = 0; step < 400; ++step) {
    const long double middle = low > 0 ? std::sqrt(low) * std::sqrt(high) : high * 1e-60L;
    (middle < deep * std::tanh(kTurn * depth / middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace

TEST_CASE("the length of waves solves the dispersion relation to the last digits") {
  Random random = seeded_generator("wavelengths");
  for (std::int64_t c = 0; c < case_count(2000); ++c) {
    const double depth = scaled(random, 1e-12, 1e8), period = scaled(random, 1e-3, 1e7);
    CAPTURE(depth);
    CAPTURE(period);
    const auto expected = static_cast<double>(by_bisection(depth, period));
    CHECK(std::fabs(wavelength(depth, period) - expected) <= 8e-16 * expected);
  }
}

TEST_CASE("the length of waves at the ends of the numbers") {
  CHECK(wavelength(0, 10) == 0);
  CHECK(wavelength(10, 0) == 0);
  CHECK(wavelength(0, 0) == 0);
  CHECK(std::isnan(wavelength(-1, 10)));
  CHECK(std::isnan(wavelength(10, -1)));
  CHECK(std::isnan(wavelength(NAN, 10)));
  CHECK(std::isnan(wavelength(10, NAN)));
  CHECK(wavelength(kInfinity, 10) == doctest::Approx(9.81 * 100 / (2 * std::numbers::pi)));
  CHECK(wavelength(10, 1e200) == doctest::Approx(1e200 * std::sqrt(98.1)));
  CHECK(wavelength(1e-300, 10) == doctest::Approx(10 * std::sqrt(9.81e-300)));
  CHECK(wavelength(3000, 44712) == doctest::Approx(44712 * std::sqrt(9.81 * 3000)).epsilon(1e-3));  // a tide
}

TEST_CASE("the length for a Courant number") {
  const auto at = [](const char* text) { return Expression(text).at({20, 4}); };
  CHECK(at("courant(x, 2)") == 2 * std::sqrt(9.81 * 20) / 0.5);
  CHECK(at("courant(x, 2, 0.25)") == 2 * std::sqrt(9.81 * 20) / 0.25);
  CHECK(at("courant(x, 2, 1, 3)") == 2 * (std::sqrt(9.81 * 20) + 3));
  CHECK(at("courant(0.1, 2, 1)") == at("courant(-70, 2, 1)"));
  CHECK(at("courant(-70, 2, 1)") == 2 * std::sqrt(9.81));
  CHECK(std::isnan(at("courant(sqrt(-x), 2)")));
}

TEST_CASE("values and slopes of waves are within what is known of them over boxes") {
  Random random = seeded_generator("waves over boxes");
  int bounded = 0;
  constexpr std::int64_t kCases = 3000;
  for (std::int64_t c = 0; more_cases(c, kCases, bounded > 1000); ++c) {
    const char* formulas[] = {"wavelength(x, y)",       "wavelength(x, 8)",        "wavelength(0.01*x*y, 0.1*y + 2)",
                              "courant(x, 8)",          "courant(x, y)",           "courant(30 - x, y, 0.5, 0.1*x)",
                              "courant(x, 2, y, x/50)", "wavelength(x - 1, y + 1)"};
    const std::string text = formulas[random() % std::size(formulas)];
    const Point low{scaled(random, 1e-3, 1e4), scaled(random, 0.1, 1e3)};
    const double width = scaled(random, 1e-6, 1e3);
    const Box box{low, {low.x + width, low.y + width}};
    CAPTURE(text);
    CAPTURE(low.x);
    CAPTURE(low.y);
    CAPTURE(width);
    const Expression expression(text);
    const Variation found = expression.over(box);
    if (found.value.undefined) continue;
    bounded += std::isfinite(found.steepest()) ? 1 : 0;
    const double rounding = 1e-13 * std::max(std::fabs(found.value.low), std::fabs(found.value.high));
    for (int k = 0; k < 10; ++k) {
      const auto between = [&](double a) { return random() % 3 == 0 ? a : a + width * uniform(random, 0, 1); };
      const Point p{between(low.x), between(low.y)}, q{between(low.x), between(low.y)};
      const double here = expression.at(p);
      REQUIRE(found.value.holds(here));
      check_slopes(expression, found, p, q, rounding);
    }
  }
}

TEST_CASE("bounds of waves are close") {
  Random random = seeded_generator("close bounds of waves");
  for (std::int64_t c = 0; c < case_count(1000); ++c) {
    const double depth = scaled(random, 1e-2, 1e4), period = scaled(random, 1, 1e5), width = 1e-4 * depth;
    CAPTURE(depth);
    CAPTURE(period);
    char text[60];
    std::snprintf(text, sizeof text, "wavelength(x, %.17g)", period);
    const Expression expression(text);
    const Variation found = expression.over({{depth, 0}, {depth + width, 0}});
    const double rise = (expression.at({depth + width, 0}) - expression.at({depth, 0})) / width;
    CHECK(found.value.high - found.value.low <= 1.001 * rise * width + 1e-13 * found.value.high);
    CHECK(found.in_x.high <= 1.01 * rise + 1e-8 * found.value.high / depth);
    CHECK(found.in_x.low >= 0.99 * rise - 1e-8 * found.value.high / depth);
  }
}
