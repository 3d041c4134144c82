#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "property/cases.hpp"
#include "pslg/point_welder.hpp"
#include "support/random.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// The oracle looks at all points.
class QuadraticWelder {
 public:
  explicit QuadraticWelder(double least) : least_(least) {}

  std::int32_t add(const Point& p) {
    std::int32_t nearest = -1;
    double least = INFINITY;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double dx = p.x - points_[i].x, dy = p.y - points_[i].y, squared = dx * dx + dy * dy;
      const double close = std::max({least_, rounding_at(p), rounding_at(points_[i])});
      if (squared > close * close || squared >= least) continue;
      nearest = static_cast<std::int32_t>(i);
      least = squared;
    }
    if (nearest >= 0) return nearest;
    points_.push_back(p);
    return static_cast<std::int32_t>(points_.size()) - 1;
  }

 private:
  static double rounding_at(const Point& p) { return 0x1p-50 * std::max(std::fabs(p.x), std::fabs(p.y)); }

  double least_;
  std::vector<Point> points_;
};

/// Draws coordinates where cells meet: at powers of two, zero, and multiples of the sizes of cells, with few digits or
/// a few units in the last place beside them.
class Coordinates {
 public:
  Coordinates(Random& random, int exponent) : random_(random), exponent_(exponent) {}

  double draw() {
    const double power = std::ldexp(1.0, exponent_ + integer(random_, -1, 1));
    double base = power;
    switch (integer(random_, 0, 3)) {
      case 0:
        base = 0;
        break;
      case 1:
        base = power * integer(random_, -8, 8) / 8;
        break;
      case 2:  // a border of cells
        base = power * (1 + integer(random_, 0, 3) * 0x1p-44);
        break;
      default:
        break;
    }
    if (integer(random_, 0, 1) == 1) base = -base;
    return base + integer(random_, -6, 6) * std::ldexp(1.0, exponent_ - integer(random_, 50, 54));
  }

 private:
  Random& random_;
  int exponent_;
};

}  // namespace

TEST_CASE("points are welded as if each were compared with all others, at any power of two") {
  Random random = seeded_generator("point_welder");
  std::int64_t welded = 0, kept = 0;
  const std::int64_t cases = case_count(3000);
  for (std::int64_t i = 0; i < cases; ++i) {
    CAPTURE(i);
    const int exponent = integer(random, -100, 200);
    const double leasts[] = {0, std::ldexp(1.0, exponent - 52), std::ldexp(1.3, exponent - 40),
                             std::ldexp(1.0, exponent - 3)};
    const double least = leasts[integer(random, 0, 3)];
    CAPTURE(least);
    Coordinates coordinates(random, exponent);
    PointWelder welder(16, Closeness(least));
    QuadraticWelder oracle(least);
    std::vector<Point> added;
    for (int k = 0; k < 40; ++k) {
      Point p{coordinates.draw(), coordinates.draw()};
      if (!added.empty() && integer(random, 0, 3) == 0)
        p = added[static_cast<std::size_t>(integer(random, 0, static_cast<std::int32_t>(added.size()) - 1))];
      CAPTURE(p.x);
      CAPTURE(p.y);
      added.push_back(p);
      const std::int32_t found = welder.add(p);
      REQUIRE(found == oracle.add(p));
    }
    kept += static_cast<std::int64_t>(welder.points().size());
    welded += static_cast<std::int64_t>(added.size() - welder.points().size());
  }
  // The points really met each other.
  CHECK(welded > 10 * cases);
  CHECK(kept > 10 * cases);
}

TEST_CASE("a point equal to one of the set is found at every power of two, whatever the signs") {
  for (int exponent = -170; exponent <= 240; ++exponent)
    for (const double x : {-1.0, -0.75, 0.0, 0.75, 1.0})
      for (const double y : {-1.0, -0.75, 0.0, 0.75, 1.0}) {
        const Point p{std::ldexp(x, exponent), std::ldexp(y, exponent)};
        PointWelder welder(4);
        CHECK(welder.add(p) == 0);
        CHECK(welder.add(p) == 0);
      }
}
