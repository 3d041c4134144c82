#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "property/cases.hpp"
#include "sizing/expression.hpp"
#include "sizing/outline_curvature.hpp"
#include "support/check_slopes.hpp"
#include "support/infinity.hpp"
#include "support/random.hpp"

// Curvatures of random outlines against circles through three points in a row, found by a look at each segment.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

double gap(const Point& p, const Point& q) {
  return std::hypot(p.x - q.x, p.y - q.y);
}

using Ring = std::vector<Point>;

Ring random_ring(Random& random) {
  const int count = static_cast<int>(3 + random() % 40);
  const double least = uniform(random, 0.2, 1);
  Ring ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = uniform(random, least, 1);
    ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring;
}

OutlineSegments segments_of(const Ring& ring) {
  OutlineSegments all;
  for (std::size_t i = 0; i < ring.size(); ++i) all.push_back({ring[i], ring[(i + 1) % ring.size()]});
  return all;
}

/// 1 over the radius, from the center, where the bisectors of two chords meet.
double through(const Point& p, const Point& q, const Point& r) {
  const double ax = p.x - q.x, ay = p.y - q.y, bx = r.x - q.x, by = r.y - q.y, twice = 2 * (ax * by - ay * bx);
  const double a = ax * ax + ay * ay, b = bx * bx + by * by;
  return 1 / std::hypot((by * a - ay * b) / twice, (ax * b - bx * a) / twice);
}

struct Nearest {
  double distance, curvature;
};

/// Of each segment.
std::vector<Nearest> look_at_each(const Ring& ring, const Point& p) {
  const std::size_t n = ring.size();
  std::vector<Nearest> all;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &before = ring[(i + n - 1) % n], &a = ring[i], &b = ring[(i + 1) % n], &behind = ring[(i + 2) % n];
    const double ex = b.x - a.x, ey = b.y - a.y;
    const double t = std::clamp(((p.x - a.x) * ex + (p.y - a.y) * ey) / (ex * ex + ey * ey), 0.0, 1.0);
    all.push_back({gap(p, {a.x + t * ex, a.y + t * ey}), (1 - t) * through(before, a, b) + t * through(a, b, behind)});
  }
  return all;
}

constexpr Box kAround{{-1.2, -1.2}, {1.2, 1.2}};

}  // namespace

TEST_CASE("curvatures are those of circles through the nearest points in a row") {
  Random random = seeded_generator("curvatures");
  for (std::int64_t c = 0; c < case_count(100); ++c) {
    const Ring ring = random_ring(random);
    const OutlineCurvature curvature(segments_of(ring));
    for (int k = 0; k < 60; ++k) {
      const Point p = somewhere_in(random, kAround);
      const std::vector<Nearest> all = look_at_each(ring, p);
      const double least = std::ranges::min(all, {}, &Nearest::distance).distance;
      const double found = curvature.at(p);
      CHECK(std::ranges::any_of(all, [&](const Nearest& s) {
        return s.distance <= least + 1e-12 && std::fabs(s.curvature - found) <= 1e-6 + 1e-9 * found;
      }));
    }
  }
}

TEST_CASE("circles, straight lines and what is divided by them") {
  Ring circle;
  for (int i = 0; i < 90; ++i)
    circle.push_back({3 + 2 * std::cos(2 * std::numbers::pi * i / 90), 2 * std::sin(2 * std::numbers::pi * i / 90)});
  const OutlineCurvature round(segments_of(circle));
  for (const Point& p : {Point{3, 0}, {5, 0}, {2, 7}, {3.3, 1.1}}) CHECK(round.at(p) == doctest::Approx(0.5));
  const Ring box{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {0, 3}};
  const OutlineCurvature square(segments_of(box));
  CHECK(square.at({1.5, 0.1}) == doctest::Approx(1e-6 / std::hypot(3, 3)));
  const Expression length("0.3/curvature()", nullptr, {}, [&] { return segments_of(box); });
  CHECK(length.at({1.5, 0.1}) == doctest::Approx(0.3e6 * std::hypot(3, 3)));
  CHECK_FALSE(length.over({{0, 0}, {3, 3}}).value.undefined);
}

TEST_CASE("within smaller and smaller boxes curvatures stay the same, and bounds hold values and slopes") {
  Random random = seeded_generator("curvatures within boxes");
  int narrowed = 0, sloped = 0, boxes = 0;
  for (std::int64_t c = 0; c < case_count(60); ++c) {
    CAPTURE(c);
    const Ring ring = random_ring(random);
    const auto whole = std::make_shared<const OutlineCurvature>(segments_of(ring));
    for (int k = 0; k < 10; ++k) {
      std::shared_ptr<const PlaneFunction> function = whole;
      const Point target = somewhere_in(random, kAround);
      Box box = Box::around(target, target, 1.5);
      for (int depth = 0; depth < 14; ++depth, ++boxes) {
        if (auto less = function->within(box); less != nullptr) function = std::move(less), ++narrowed;
        const Variation found = function->over(box);
        sloped += std::isfinite(found.steepest()) ? 1 : 0;
        for (int n = 0; n < 8; ++n) {
          const Point p = somewhere_in(random, box), q = somewhere_in(random, box);
          const double at_p = function->at(p);
          REQUIRE(at_p == whole->at(p));
          REQUIRE(found.value.holds(at_p));
          check_slopes(*function, found, p, q, 1e-11);
        }
        const double half = (box.high.x - box.low.x) / 4;
        const Point m = somewhere_in(random, Box::around(target, target, half / 2));
        box = Box::around(m, m, half);
      }
    }
  }
  CHECK(narrowed > boxes / 8);
  CHECK(sloped > boxes / 8);
}
