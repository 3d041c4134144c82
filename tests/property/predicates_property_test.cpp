#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include "geometry/predicates.hpp"
#include "property/cases.hpp"
#include "support/random.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Integer = boost::multiprecision::cpp_int;
using Quad = std::array<Point, 4>;

// --- The oracle: determinants in integers, every coordinate scaled by one power of two. ---

struct IntegerPoint {
  Integer x, y;
};

Integer scaled_to_integer(double value, int exponent) {
  if (value == 0) return 0;
  const int own = std::ilogb(value) - 52;
  Integer scaled = static_cast<std::int64_t>(std::scalbn(value, -own));
  scaled <<= own - exponent;
  return scaled;
}

template <std::size_t N>
std::array<IntegerPoint, N> scaled_to_integers(const std::array<Point, N>& points) {
  int exponent = 1000;
  for (const Point& p : points)
    for (const double v : {p.x, p.y})
      if (v != 0) exponent = std::min(exponent, std::ilogb(v) - 52);
  std::array<IntegerPoint, N> integers;
  for (std::size_t i = 0; i < N; ++i)
    integers[i] = {scaled_to_integer(points[i].x, exponent), scaled_to_integer(points[i].y, exponent)};
  return integers;
}

IntegerPoint operator-(const IntegerPoint& p, const IntegerPoint& q) {
  return {p.x - q.x, p.y - q.y};
}
Integer cross(const IntegerPoint& p, const IntegerPoint& q) {
  return p.x * q.y - p.y * q.x;
}
Integer norm(const IntegerPoint& p) {
  return p.x * p.x + p.y * p.y;
}

int true_orient2d(const Quad& q) {
  const auto p = scaled_to_integers(std::array{q[0], q[1], q[2]});
  return cross(p[1] - p[0], p[2] - p[0]).sign();
}

int true_incircle(const Quad& q) {
  const auto p = scaled_to_integers(q);
  const IntegerPoint a = p[0] - p[3], b = p[1] - p[3], c = p[2] - p[3];
  return Integer(norm(a) * cross(b, c) + norm(b) * cross(c, a) + norm(c) * cross(a, b)).sign();
}

int sign(double value) {
  return (value > 0) - (value < 0);
}

int naive_orient2d(const Quad& q) {
  const auto& [a, b, c, d] = q;
  return sign((a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x));
}

int naive_incircle(const Quad& q) {
  const auto& [a, b, c, d] = q;
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  return sign((ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) +
              (cx * cx + cy * cy) * (ax * by - ay * bx));
}

// --- Generators. ---

/// `value` moved by up to `ulps` representable numbers.
double nudged(Random& random, double value, int ulps) {
  const int steps = integer(random, -ulps, ulps);
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps > 0 ? HUGE_VAL : -HUGE_VAL);
  return std::fabs(value) < kSmallestCoordinate ? 0 : value;
}

Quad random_points(Random& random) {
  Quad q;
  for (Point& p : q) p = {uniform(random, 0, 1), uniform(random, 0, 1)};
  return q;
}

/// Clusters of a size between 1e-8 and 0.1 degrees somewhere in a bay.
Quad longitude_latitude(Random& random) {
  const double x = uniform(random, -77.5, -75.7), y = uniform(random, 36.7, 39.7);
  const double size = std::pow(10, uniform(random, -8, -1));
  Quad q;
  for (Point& p : q) p = {x + uniform(random, -size, size), y + uniform(random, -size, size)};
  return q;
}

Quad near_collinear(Random& random) {
  const Point a{uniform(random, -1, 1), uniform(random, -1, 1)}, b{uniform(random, -1, 1), uniform(random, -1, 1)};
  Quad q{a, b};
  for (Point& p : q) {
    const double t = integer(random, 0, 2) ? uniform(random, -2, 2) : 0.25 * integer(random, -4, 4);
    p = {nudged(random, a.x + t * (b.x - a.x), 3), nudged(random, a.y + t * (b.y - a.y), 3)};
  }
  return q;
}

Quad near_cocircular(Random& random) {
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
  const double radius = std::pow(10, uniform(random, -6, 3));
  Quad q;
  for (Point& p : q) {
    const double angle = uniform(random, -M_PI, M_PI);
    p = {nudged(random, x + radius * std::cos(angle), 2), nudged(random, y + radius * std::sin(angle), 2)};
  }
  return q;
}

/// Small integers: about a third of all triples and a tenth of all quadruples are degenerate. Half of them on a grid
/// whose spacing is not a power of two, far from the origin, so that coordinates and differences round.
Quad grid(Random& random) {
  const bool rounded = integer(random, 0, 1);
  const double spacing = rounded ? 0.1 : std::scalbn(1.0, integer(random, -40, 40));
  const double offset = rounded ? integer(random, 0, 1000) : 0;
  Quad q;
  for (Point& p : q) p = {(offset + integer(random, -3, 3)) * spacing, (offset + integer(random, -3, 3)) * spacing};
  return q;
}

double any_magnitude(Random& random, int low, int high) {
  const double mantissa = uniform(random, 1, 2);
  return std::scalbn(integer(random, 0, 1) ? mantissa : -mantissa, integer(random, low, high));
}

Quad wide_exponents(Random& random) {
  const int low = integer(random, -190, 200), high = std::min(239, low + integer(random, 0, 400));
  Quad q;
  for (Point& p : q) p = {any_magnitude(random, low, high), any_magnitude(random, low, high)};
  return q;
}

/// Zero and the ends of the range, with full and with short mantissas, where overflow and underflow would occur.
Quad ends_of_range(Random& random) {
  const auto coordinate = [&] {
    const double below_max = kMaxCoordinate * (1 - 0x1p-53);
    const double choices[] = {0,
                              kMaxCoordinate,
                              below_max,
                              nudged(random, below_max, 3),
                              kSmallestCoordinate,
                              kSmallestCoordinate * (1 + 0x1p-52 * integer(random, 0, 3)),
                              kSmallestCoordinate * uniform(random, 1, 2)};
    const double value = choices[integer(random, 0, 6)];
    return integer(random, 0, 1) ? value : -value;
  };
  // Only one end in half of the cases: then all of the terms are extreme.
  const int end = integer(random, 0, 3);
  Quad q;
  for (Point& p : q)
    for (double* v : {&p.x, &p.y}) do {
        *v = coordinate();
      } while ((end == 0 && std::fabs(*v) > 1) || (end == 1 && *v != 0 && std::fabs(*v) < 1));
  return q;
}

// --- The properties. ---

std::string printed(const Quad& q) {
  std::string text;
  char buffer[80];
  for (const Point& p : q) {
    std::snprintf(buffer, sizeof buffer, "{%a, %a} ", p.x, p.y);
    text += buffer;
  }
  return text;
}

/// The problem of the signs for these points, or empty.
std::string wrong_sign(const Quad& q, int orientation, int circle) {
  const auto& [a, b, c, d] = q;
  if (sign(orient2d(a, b, c)) != orientation) return "orient2d";
  if (sign(orient2d_exact(a, b, c)) != orientation) return "orient2d_exact";
  if (sign(orient2d(b, a, c)) != -orientation) return "orient2d of a swap";
  if (sign(orient2d(a, c, b)) != -orientation) return "orient2d of a swap";
  if (sign(incircle(a, b, c, d)) != circle) return "incircle";
  if (sign(incircle_exact(a, b, c, d)) != circle) return "incircle_exact";
  if (sign(incircle(b, a, c, d)) != -circle) return "incircle of a swap";
  if (sign(incircle(a, c, b, d)) != -circle) return "incircle of a swap";
  if (sign(incircle(a, b, d, c)) != -circle) return "incircle of a swap";
  return {};
}

/// How often the true value is zero and how often plain doubles get the sign wrong: shows that a generator is
/// effective.
struct Tally {
  double zero_orient2d = 0, zero_incircle = 0, naive_wrong_orient2d = 0, naive_wrong_incircle = 0;
};

Tally check_signs(const char* name, const std::function<Quad(Random&)>& generate) {
  Random random = testing::seeded_generator(name);
  const std::int64_t cases = testing::case_count(150000);
  std::int64_t failures = 0;
  Tally tally;
  for (std::int64_t i = 0; i < cases; ++i) {
    const Quad q = generate(random);
    const int orientation = true_orient2d(q), circle = true_incircle(q);
    tally.zero_orient2d += orientation == 0;
    tally.zero_incircle += circle == 0;
    tally.naive_wrong_orient2d += naive_orient2d(q) != orientation;
    tally.naive_wrong_incircle += naive_incircle(q) != circle;
    const std::string wrong = wrong_sign(q, orientation, circle);
    if (!wrong.empty() && failures++ < 5) MESSAGE(wrong << " is wrong for " << printed(q));
  }
  CHECK(failures == 0);
  for (double* count :
       {&tally.zero_orient2d, &tally.zero_incircle, &tally.naive_wrong_orient2d, &tally.naive_wrong_incircle})
    *count /= static_cast<double>(cases);
  std::printf("  %lld cases, zero %.4f %.4f, plain doubles wrong %.4f %.4f\n", static_cast<long long>(cases),
              tally.zero_orient2d, tally.zero_incircle, tally.naive_wrong_orient2d, tally.naive_wrong_incircle);
  return tally;
}

}  // namespace

TEST_CASE("signs are exact for random points") {
  check_signs("random points", random_points);
}

TEST_CASE("signs are exact for points of a shoreline") {
  check_signs("longitude and latitude", longitude_latitude);
}

TEST_CASE("signs are exact for nearly collinear points") {
  const Tally tally = check_signs("nearly collinear", near_collinear);
  CHECK(tally.naive_wrong_orient2d > 0.02);
  CHECK(tally.zero_orient2d > 0.0002);
}

TEST_CASE("signs are exact for nearly cocircular points") {
  const Tally tally = check_signs("nearly cocircular", near_cocircular);
  CHECK(tally.naive_wrong_incircle > 0.02);
}

TEST_CASE("signs are exact for points on a grid") {
  const Tally tally = check_signs("grid", grid);
  CHECK(tally.zero_orient2d > 0.05);
  CHECK(tally.zero_incircle > 0.05);
  CHECK(tally.naive_wrong_incircle > 0.001);
}

TEST_CASE("signs are exact for wide exponents") {
  check_signs("wide exponents", wide_exponents);
}

TEST_CASE("signs are exact at the ends of the coordinate range") {
  const Tally tally = check_signs("ends of the range", ends_of_range);
  CHECK(tally.zero_incircle > 0.001);
  CHECK(tally.naive_wrong_incircle > 0.001);
}
