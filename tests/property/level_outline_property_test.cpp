#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "property/cases.hpp"
#include "raster/level_outline.hpp"
#include "support/random.hpp"

// Outlines of random rasters against the values: what is inside, what is connected, and whether rings are simple.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct Drawn {
  RasterFrame frame;
  std::vector<float> values;
  double level = 0;
  bool below = false;

  [[nodiscard]] Point point(std::int64_t i, std::int64_t j) const {
    return {frame.first.x + static_cast<double>(i) * frame.dx, frame.first.y + static_cast<double>(j) * frame.dy};
  }
  /// How far the value is beyond the level; NaN: there is none.
  [[nodiscard]] double beyond(std::int64_t i, std::int64_t j) const {
    const double value = values[static_cast<std::size_t>(j * frame.columns + i)];
    return below ? level - value : value - level;
  }
  /// Whether the outline passes through a point instead of near it.
  [[nodiscard]] bool is_snapped(std::int64_t i, std::int64_t j) const {
    const auto near = [&](std::int64_t k, std::int64_t l) {
      if (k < 0 || l < 0 || k >= frame.columns || l >= frame.rows || inside(i, j) == inside(k, l)) return false;
      const double here = std::abs(beyond(i, j)), there = std::abs(beyond(k, l));
      return here < 1.0001 * LevelOutline::kSnap * (here + there);
    };
    return near(i - 1, j) || near(i + 1, j) || near(i, j - 1) || near(i, j + 1);
  }
  [[nodiscard]] bool inside(std::int64_t i, std::int64_t j) const { return beyond(i, j) > 0; }
  [[nodiscard]] std::vector<LevelPart> parts() const {
    LevelOutline outline(frame, level, below);
    for (std::int64_t j = frame.rows - 1; j >= 0; --j)
      outline.add_row(std::span(values).subspan(static_cast<std::size_t>(j * frame.columns),
                                                static_cast<std::size_t>(frame.columns)));
    return outline.parts();
  }
};

/// Noise, small whole numbers with many that equal the level, or hills; some without values.
Drawn random_raster(Random& random, bool hills) {
  const auto count = [&] { return 2 + static_cast<std::int64_t>(random() % (hills ? 150 : 25)); };
  Drawn drawn;
  drawn.frame = {count(),
                 count(),
                 {uniform(random, -1e3, 1e3), uniform(random, -1e3, 1e3)},
                 std::exp(uniform(random, -2, 2)),
                 std::exp(uniform(random, -2, 2))};
  const bool whole = random() % 2 == 0;
  const double missing = random() % 3 == 0 ? uniform(random, 0, 0.3) : 0;
  const double u = uniform(random, 0.02, 0.2), v = uniform(random, 0.02, 0.2), w = uniform(random, -0.2, 0.2);
  for (std::int64_t j = 0; j < drawn.frame.rows; ++j)
    for (std::int64_t i = 0; i < drawn.frame.columns; ++i) {
      const auto x = static_cast<double>(i), y = static_cast<double>(j);
      double value =
          hills ? 2 * std::sin(u * x) + 2 * std::cos(v * y) + std::sin(w * (x + 2 * y)) : uniform(random, -3, 3);
      if (whole && !hills) value = std::round(value);
      if (uniform(random, 0, 1) < missing) value = std::numeric_limits<double>::quiet_NaN();
      drawn.values.push_back(static_cast<float>(value));
    }
  drawn.level = whole ? static_cast<double>(static_cast<std::int64_t>(random() % 3) - 1) : uniform(random, -2, 2);
  drawn.below = random() % 2 == 0;
  return drawn;
}

struct Line {
  Point a, b;
};

std::vector<Line> edges_of(const std::vector<LevelPart>& parts) {
  std::vector<Line> edges;
  for (const LevelPart& part : parts)
    for (const PolygonRing& ring : part.rings)
      for (std::size_t k = 0; k < ring.size(); ++k) edges.push_back({ring[k], ring[(k + 1) % ring.size()]});
  return edges;
}

double sign_of(const Line& e, const Point& p) {
  return orient2d(e.a, e.b, p);
}

/// Whether two edges have more than an end in common.
bool overlap(const Line& e, const Line& f) {
  if (!Box::around(e.a, e.b).overlaps(Box::around(f.a, f.b))) return false;
  const bool common = e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b;
  const double a = sign_of(e, f.a), b = sign_of(e, f.b), c = sign_of(f, e.a), d = sign_of(f, e.b);
  if (!common) return a * b <= 0 && c * d <= 0;
  if (a != 0 || b != 0) return false;  // not on one line
  const Point& shared = e.a == f.a || e.a == f.b ? e.a : e.b;
  const Point &p = e.a == shared ? e.b : e.a, &q = f.a == shared ? f.b : f.a;
  return (p.x - shared.x) * (q.x - shared.x) + (p.y - shared.y) * (q.y - shared.y) > 0;
}

std::size_t count_overlaps(const std::vector<Line>& edges) {
  std::vector<Line> sorted = edges;
  const auto left = [](const Line& e) { return std::min(e.a.x, e.b.x); };
  std::ranges::sort(sorted, {}, left);
  std::size_t found = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k)
    for (std::size_t n = k + 1; n < sorted.size() && left(sorted[n]) <= std::max(sorted[k].a.x, sorted[k].b.x); ++n)
      found += overlap(sorted[k], sorted[n]) ? 1 : 0;
  return found;
}

/// The part that holds a point, if it is one alone; -1: none, -2: several.
int part_at(const std::vector<LevelPart>& parts, const Point& p) {
  int found = -1;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::vector<const PolygonRing*> rings;
    for (const PolygonRing& ring : parts[k].rings) rings.push_back(&ring);
    if (is_inside(rings, p)) found = found == -1 ? static_cast<int>(k) : -2;
  }
  return found;
}

double distance(const Point& p, const Line& e) {
  const double x = e.b.x - e.a.x, y = e.b.y - e.a.y;
  const double t = std::clamp(((p.x - e.a.x) * x + (p.y - e.a.y) * y) / (x * x + y * y), 0.0, 1.0);
  return std::hypot(p.x - e.a.x - t * x, p.y - e.a.y - t * y);
}

double distance(const Point& p, const std::vector<Line>& edges) {
  double least = std::numeric_limits<double>::infinity();
  for (const Line& e : edges) least = std::min(least, distance(p, e));
  return least;
}

double twice_area(const PolygonRing& ring) {
  double sum = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point &p = ring[k], &q = ring[(k + 1) % ring.size()];
    sum += (p.x - ring[0].x) * (q.y - ring[0].y) - (p.y - ring[0].y) * (q.x - ring[0].x);
  }
  return sum;
}

}  // namespace

TEST_CASE("rings of a level are simple, and hold the points beyond it, in parts as neighbors are connected") {
  Random random = seeded_generator("level outlines");
  int holes = 0, touching = 0, saddles = 0;
  for (std::int64_t tried = 0; more_cases(tried, 400, holes > 20 && touching > 20 && saddles > 20); ++tried) {
    CAPTURE(tried);
    const Drawn drawn = random_raster(random, false);
    const RasterFrame& f = drawn.frame;
    const std::vector<LevelPart> parts = drawn.parts();
    const std::vector<Line> edges = edges_of(parts);
    CHECK(count_overlaps(edges) == 0);
    for (const Line& e : edges)
      CHECK(std::hypot((e.b.x - e.a.x) / f.dx, (e.b.y - e.a.y) / f.dy) > LevelOutline::kSnap * (1 - 1e-9));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      CHECK(parts[k].area > 0);
      if (k > 0) CHECK(parts[k - 1].area >= parts[k].area);
      double area = 0;
      for (std::size_t n = 0; n < parts[k].rings.size(); ++n) {
        CHECK((twice_area(parts[k].rings[n]) > 0) == (n == 0));
        area += twice_area(parts[k].rings[n]) / 2;
      }
      CHECK(parts[k].area == doctest::Approx(area));
      holes += static_cast<int>(parts[k].rings.size()) - 1;
    }
    std::vector<Point> ends;
    for (const Line& e : edges) ends.push_back(e.a);
    std::ranges::sort(ends, {}, [](const Point& p) { return std::pair{p.x, p.y}; });
    if (std::ranges::adjacent_find(ends) != ends.end()) ++touching;
    const double near = 1e-6 * std::min(f.dx, f.dy);
    std::vector<int> part(drawn.values.size(), -3);  // -3: the outline passes through
    for (std::int64_t j = 0; j < f.rows; ++j)
      for (std::int64_t i = 0; i < f.columns; ++i) {
        const auto k = static_cast<std::size_t>(j * f.columns + i);
        if (drawn.is_snapped(i, j) || distance(drawn.point(i, j), edges) < near) continue;
        part[k] = part_at(parts, drawn.point(i, j));
        CHECK((part[k] >= 0) == drawn.inside(i, j));
        if (i > 0 && part[k] >= 0 && part[k - 1] >= 0) CHECK(part[k] == part[k - 1]);
        const auto below = k - static_cast<std::size_t>(f.columns);
        if (j > 0 && part[k] >= 0 && part[below] >= 0) CHECK(part[k] == part[below]);
      }
    for (std::int64_t j = 0; j + 1 < f.rows; ++j)
      for (std::int64_t i = 0; i + 1 < f.columns; ++i) {
        const double a = drawn.beyond(i, j), b = drawn.beyond(i + 1, j), c = drawn.beyond(i + 1, j + 1),
                     d = drawn.beyond(i, j + 1);
        if (!((a > 0) == (c > 0) && (b > 0) == (d > 0) && (a > 0) != (b > 0)) || std::isnan(a + b + c + d)) continue;
        const double s = (a - d) / (a - b + c - d), t = (a - b) / (a - b + c - d);
        const Point saddle{drawn.point(i, j).x + s * f.dx, drawn.point(i, j).y + t * f.dy};
        if (distance(saddle, edges) < 1.01 * LevelOutline::kSnap * std::hypot(f.dx, f.dy)) continue;
        ++saddles;
        CHECK((part_at(parts, saddle) >= 0) == ((a * c - b * d) / (a - b + c - d) > 0));
      }
  }
}

TEST_CASE("away from the outline of a level, the bilinear interpolant says what is inside") {
  Random random = seeded_generator("hills");
  int judged = 0;
  for (std::int64_t tried = 0; more_cases(tried, 60, judged > 1000); ++tried) {
    CAPTURE(tried);
    const Drawn drawn = random_raster(random, true);
    const RasterFrame& f = drawn.frame;
    const std::vector<LevelPart> parts = drawn.parts();
    const std::vector<Line> edges = edges_of(parts);
    // Within a square, the interpolant's curve is on the other side of the chord by half a diagonal at most.
    const double far = (0.51 + LevelOutline::kSnap) * std::hypot(f.dx, f.dy);
    for (int n = 0; n < 200; ++n) {
      const double u = uniform(random, 0, static_cast<double>(f.columns - 1)),
                   v = uniform(random, 0, static_cast<double>(f.rows - 1));
      const auto i = static_cast<std::int64_t>(u), j = static_cast<std::int64_t>(v);
      const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
      const double here = (1 - t) * ((1 - s) * drawn.beyond(i, j) + s * drawn.beyond(i + 1, j)) +
                          t * ((1 - s) * drawn.beyond(i, j + 1) + s * drawn.beyond(i + 1, j + 1));
      const Point p{f.first.x + u * f.dx, f.first.y + v * f.dy};
      if (std::isnan(here) || distance(p, edges) < far) continue;
      ++judged;
      CHECK((part_at(parts, p) >= 0) == (here > 0));
    }
  }
}

TEST_CASE("sides of the raster are straight edges of many spacings, and equal values lie outside") {
  LevelOutline outline({200, 3, {0, 0}, 1, 1}, 5, false);
  const std::vector<float> six(200, 6), five(200, 5);
  outline.add_row(six);
  outline.add_row(six);
  outline.add_row(five);
  const std::vector<LevelPart> parts = outline.parts();
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].area == 199 * 2);
  REQUIRE(parts[0].rings.size() == 1);
  CHECK(parts[0].rings[0].size() < 20);
}
