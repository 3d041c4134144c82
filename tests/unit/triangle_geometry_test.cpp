#include "geometry/triangle_geometry.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/midpoint.hpp"

using namespace driftmesh;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

double distance(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Angle at which p sees ab, from directions alone.
double seen_angle(const Point& p, const Point& a, const Point& b) {
  const double turn = std::atan2(b.y - p.y, b.x - p.x) - std::atan2(a.y - p.y, a.x - p.x);
  return std::fabs(std::remainder(turn, 2 * std::numbers::pi));
}

std::vector<std::array<Point, 3>> random_triangles(int count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::array<Point, 3>> triangles;
  while (static_cast<int>(triangles.size()) < count) {
    std::array<Point, 3> t;
    for (Point& p : t) p = {uniform(random), uniform(random)};
    if (orient2d(t[0], t[1], t[2]) < 0) std::swap(t[0], t[1]);
    if (signed_area(t[0], t[1], t[2]) > 1e-4) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace

TEST_CASE("the signed area of a triangle") {
  CHECK(signed_area({0, 0}, {4, 0}, {1, 3}) == 6);
  CHECK(signed_area({0, 0}, {1, 3}, {4, 0}) == -6);
  CHECK(signed_area({0, 0}, {1, 3}, {2, 6}) == 0);
}

TEST_CASE("the circumcenter is equally far from all corners") {
  for (const auto& [a, b, c] : random_triangles(1000)) {
    const Point center = circumcenter(a, b, c);
    const double radius = distance(center, a);
    CHECK(distance(center, b) == doctest::Approx(radius).epsilon(1e-9));
    CHECK(distance(center, c) == doctest::Approx(radius).epsilon(1e-9));
  }
}

TEST_CASE("the circumcenter keeps its accuracy far from the origin") {
  // The corners are exact doubles, so the center is known: it is translated with the triangle.
  const double far = 0x1p40, size = 0x1p-8;
  const Point center = circumcenter({far, far}, {far + 4 * size, far}, {far + size, far + 3 * size});
  CHECK(center == Point{far + 2 * size, far + size});
}

TEST_CASE("computed coordinates too small for the predicates become zero") {
  CHECK(circumcenter({0, 0}, {0x1p-200, 1}, {-1, 0}).y == 0.5);
  CHECK(snap_to_zero(0x1p-191) == 0);
  CHECK(snap_to_zero(-0x1p-191) == 0);
  CHECK(snap_to_zero(-0x1p-190) == -0x1p-190);
}

// The circumcenter sees the shortest edge at twice the smallest angle, the off-center at just over theta: they coincide
// at tan(smallest) = tan(theta / 2) / 0.95.

TEST_CASE("an off-center is the circumcenter where that is near") {
  const double factor = off_center_factor(20);
  for (const auto& [a, b, c] : random_triangles(1000)) {
    if (angle_range(a, b, c).smallest < 10.6 * kDegree) continue;
    const Point center = circumcenter(a, b, c), off = off_center_of_triangle(a, b, c, factor);
    CHECK(distance(center, off) < 1e-9);
  }
}

TEST_CASE("the off-center of a skinny triangle lies on the bisector of the shortest edge at the requested angle") {
  const double theta = 25;
  int skinny = 0;
  for (const auto& [a, b, c] : random_triangles(2000)) {
    if (angle_range(a, b, c).smallest > 13.1 * kDegree) continue;
    ++skinny;
    const Point off = off_center_of_triangle(a, b, c, off_center_factor(theta));
    const bool ab = distance(a, b) <= std::min(distance(b, c), distance(c, a));
    const bool bc = !ab && distance(b, c) <= distance(c, a);
    const Point p = ab ? a : bc ? b : c, q = ab ? b : bc ? c : a;
    CHECK(distance(p, off) == doctest::Approx(distance(q, off)).epsilon(1e-9));
    CHECK(orient2d(p, q, off) > 0);
    CHECK(distance(midpoint(p, q), off) == doctest::Approx(distance(p, q) * off_center_factor(theta)));
    // The new triangle meets the bound by a small margin.
    CHECK(seen_angle(off, p, q) > theta * kDegree);
    CHECK(seen_angle(off, p, q) < (theta + 2) * kDegree);
    // It is nearer to the edge than the circumcenter.
    CHECK(distance(p, off) < distance(p, circumcenter(a, b, c)));
  }
  CHECK(skinny > 300);
}

TEST_CASE("off-centers do not depend on the corner that comes first, up to rounding") {
  const double factor = off_center_factor(30);
  for (const auto& [a, b, c] : random_triangles(100)) {
    const Point p = off_center_of_triangle(a, b, c, factor);
    CHECK(distance(p, off_center_of_triangle(b, c, a, factor)) < 1e-12);
    CHECK(distance(p, off_center_of_triangle(c, a, b, factor)) < 1e-12);
  }
}

TEST_CASE("a diametral lens holds the points that see the segment at more than its apex angle") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double apex : {90.0, 100.0, 120.0, 150.0}) {
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Point a{uniform(random), uniform(random)}, b{uniform(random), uniform(random)};
      const Point p{uniform(random), uniform(random)};
      const double seen = seen_angle(p, a, b);
      if (std::fabs(seen - apex * kDegree) < 1e-9) continue;
      inside += seen > apex * kDegree;
      const double cos_apex = apex == 90 ? 0 : std::cos(apex * kDegree);
      CHECK(in_diametral_lens(p, a, b, cos_apex) == (seen > apex * kDegree));
    }
    CHECK(inside > 20);
  }
}

TEST_CASE("the ends of a segment and the points on the diametral circle are outside") {
  const Point a{-5, 0}, b{5, 0};
  CHECK_FALSE(in_diametral_lens(a, a, b, 0));
  CHECK_FALSE(in_diametral_lens(b, a, b, -0.5));
  CHECK_FALSE(in_diametral_lens({3, 4}, a, b, 0));
  CHECK_FALSE(in_diametral_lens({7, 0}, a, b, -0.5));
  CHECK(in_diametral_lens({3, 3.9999}, a, b, 0));
  CHECK(in_diametral_lens({4.9999, 0}, a, b, -0.5));
  CHECK_FALSE(in_diametral_lens({3, 3.9999}, a, b, -0.5));
}

TEST_CASE("the angles of a triangle") {
  const AngleRange right = angle_range({0, 0}, {1, 0}, {0, std::sqrt(3.0)});
  CHECK(right.smallest == doctest::Approx(30 * kDegree));
  CHECK(right.largest == doctest::Approx(90 * kDegree));
  const AngleRange flat = angle_range({0, 0}, {2, 0}, {1, 0});
  CHECK(flat.smallest == 0);
  CHECK(flat.largest == doctest::Approx(std::numbers::pi));
  for (const auto& [a, b, c] : random_triangles(100))
    CHECK(angle_at(a, b, c) + angle_at(b, c, a) + angle_at(c, a, b) == doctest::Approx(std::numbers::pi));
}
