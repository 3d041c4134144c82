#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "mesh/cdt.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"

// Simplified lines stay where they were, and everything stays on its side of them.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Long double, brute force.
double exact_distance(const Point& p, const Point& a, const Point& b) {
  const long double ex = static_cast<long double>(b.x) - a.x, ey = static_cast<long double>(b.y) - a.y;
  const long double px = static_cast<long double>(p.x) - a.x, py = static_cast<long double>(p.y) - a.y;
  const long double t = std::clamp<long double>((px * ex + py * ey) / (ex * ex + ey * ey), 0, 1);
  return static_cast<double>(std::hypot(px - t * ex, py - t * ey));
}

double exact_distance(const Point& p, const Pslg& pslg) {
  double least = HUGE_VAL;
  for (const auto& s : pslg.segments) least = std::min(least, exact_distance(p, pslg.points[s.a], pslg.points[s.b]));
  return least;
}

constexpr double kNowhere = -1e9;  // an attribute that no region has

/// The attribute of the region where p lies, or kNowhere outside the domain.
double region_at(const Pslg& pslg, const Triangulation& mesh, const Point& p) {
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
    if (orient2d(a, b, p) < 0 || orient2d(b, c, p) < 0 || orient2d(c, a, p) < 0) continue;
    const int label = mesh.region.empty() ? 0 : mesh.region[t];
    return label == 0 ? 0 : pslg.regions[label - 1].attribute;
  }
  return kNowhere;
}

Box box_of(const Pslg& pslg) {
  return Box::of(pslg.points);
}

/// A random domain whose lines have many points: midpoints, shaken a little where the result is still planar.
Pslg detailed(std::uint64_t seed, std::mt19937_64& random) {
  oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
  if (seed % 2 == 0) shape.inner_segments = shape.dangling_segments = 0;  // rings without junctions
  Pslg pslg = oracles::make_random_pslg(seed, shape).input;
  repair(pslg);
  if (seed % 2 == 0) pslg.point_markers.clear();
  if (seed % 2 == 0)
    for (auto& s : pslg.segments) s.marker = 1;
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) pslg.regions[i].attribute = static_cast<double>(i + 1);
  std::uniform_real_distribution<double> shake(-0.1, 0.1);
  for (int round = 0; round < 3; ++round) {
    Pslg finer = pslg;
    for (const auto& s : pslg.segments) {
      const Point &a = pslg.points[s.a], &b = pslg.points[s.b];
      const double push = shake(random);
      const Point middle{(a.x + b.x) / 2 - push * (b.y - a.y), (a.y + b.y) / 2 + push * (b.x - a.x)};
      const auto at = static_cast<std::int32_t>(finer.points.size());
      finer.points.push_back(middle);
      if (!finer.point_markers.empty()) finer.point_markers.push_back(finer.point_markers[s.a]);
      finer.attributes.resize(finer.points.size() * finer.attributes_per_point, push);
      auto& first = *std::ranges::find(finer.segments, s);
      const std::int32_t end = std::exchange(first.b, at);
      finer.segments.push_back({at, end, s.marker});
    }
    Pslg tried = finer;
    try {
      if (!repair(tried).changed()) pslg = std::move(finer);
    } catch (const Error&) {  // a seed that is now on a line
    }
  }
  return pslg;
}

Pslg circle(int points, double radius) {
  Pslg pslg;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i / points;
    pslg.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    pslg.segments.push_back({i, (i + 1) % points, 1});
  }
  return pslg;
}

void add(Pslg& to, const Pslg& other, Point by, std::int32_t marker) {
  const auto first = static_cast<std::int32_t>(to.points.size());
  for (const Point& p : other.points) to.points.push_back({p.x + by.x, p.y + by.y});
  for (const auto& s : other.segments) to.segments.push_back({s.a + first, s.b + first, marker});
}

}  // namespace

TEST_CASE("random domains keep their shape within the tolerance, and what lies where") {
  std::mt19937_64 random = seeded_generator("simplify");
  std::int64_t removed = 0, rings = 0, refused = 0, probes = 0;
  std::int64_t tried = 0;
  for (; more_cases(tried, 150, rings > 0); ++tried) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    random.seed(seed);
    const Pslg before = detailed(seed, random);
    const Box box = box_of(before);
    const double extent = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    const double tolerance = extent * std::pow(10, -std::uniform_real_distribution<double>(0.2, 4)(random));
    Pslg after = before;
    SimplifyReport report;
    try {
      report = simplify(after, tolerance);
    } catch (const InputError&) {
      ++refused;
      CHECK(tolerance > 0.1 * extent);
      continue;
    }
    removed += report.points;
    rings += report.rings;

    Pslg repaired = after;
    CHECK(!repair(repaired).changed());
    REQUIRE(report.original_point.size() == after.points.size());
    CHECK(std::ranges::is_sorted(report.original_point));
    for (std::size_t p = 0; p < after.points.size(); ++p) {
      const auto original = static_cast<std::size_t>(report.original_point[p]);
      CHECK(after.points[p] == before.points[original]);
      if (!before.point_markers.empty()) CHECK(after.point_markers[p] == before.point_markers[original]);
      for (std::int32_t k = 0; k < before.attributes_per_point; ++k)
        CHECK(after.attributes[p * before.attributes_per_point + k] ==
              before.attributes[original * before.attributes_per_point + k]);
    }
    CHECK(static_cast<std::int64_t>(before.points.size() - after.points.size()) >= report.points);

    const double most = tolerance * (1 + 1e-9);
    if (report.rings == 0)
      for (const Point& p : before.points)
        if (exact_distance(p, before) == 0) CHECK(exact_distance(p, after) <= most);
    for (const auto& s : after.segments)
      for (const double t : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9}) {
        const Point &a = after.points[s.a], &b = after.points[s.b];
        CHECK(exact_distance({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, before) <= most);
      }

    const Triangulation faces_before = triangulate(before), faces_after = triangulate(after);
    std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
    for (int k = 0; k < 60; ++k) {
      const Point p{x(random), y(random)};
      if (exact_distance(p, before) <= most) continue;
      ++probes;
      CHECK(region_at(before, faces_before, p) == region_at(after, faces_after, p));
    }
    if (report.rings == 0) {
      CHECK(after.holes == before.holes);
      CHECK(after.regions == before.regions);
    }
    Pslg again = after;
    if (report.points == 0 && report.rings == 0) CHECK(again.segments == before.segments);
  }
  MESSAGE(removed << " points, " << rings << " rings, " << probes << " probes, " << refused << " refused");
  CHECK(removed > 10 * tried);
  CHECK(rings > 0);
  CHECK(probes > 10 * tried);
}

TEST_CASE("a smooth line keeps about as many points as it needs") {
  Pslg pslg = circle(10'000, 1);
  const SimplifyReport report = simplify(pslg, 1e-3);
  const double needed = std::numbers::pi / std::acos(1 - 1e-3);  // number of chords that cut off 1e-3
  CHECK(static_cast<double>(pslg.points.size()) < 2.5 * needed);
  CHECK(report.points + static_cast<std::int64_t>(pslg.points.size()) == 10'000);
}

TEST_CASE("lines much closer to each other than the tolerance do not cross") {
  Pslg pslg = circle(2'000, 1);
  add(pslg, circle(3'000, 0.999), {0, 0}, 2);
  add(pslg, circle(500, 0.9985), {0, 0}, 3);
  pslg.regions = {{{0.99925, 0}, 2, 0}, {{0, 0}, 3, 0}};
  simplify(pslg, 0.05);
  Pslg repaired = pslg;
  CHECK(!repair(repaired).changed());
  CHECK(pslg.points.size() < 2'000);
  const Triangulation faces = triangulate(pslg);
  CHECK(region_at(pslg, faces, {0.99925, 0}) == 2);
  CHECK(region_at(pslg, faces, {0, 0}) == 3);
}

TEST_CASE("two lines between the same points stay two, and a bump with a seed stays around it") {
  Pslg lens;
  lens.points = {{0, 0}, {10, 0}, {5, 0.1}, {5, -0.1}, {-5, 0}, {15, 0}};
  lens.segments = {{0, 2, 1}, {2, 1, 1}, {0, 3, 1}, {3, 1, 1}, {4, 0, 1}, {1, 5, 1}};
  simplify(lens, 0.3);
  CHECK(lens.points.size() == 5);
  CHECK(!repair(lens).changed());

  Pslg bump;
  bump.points = {{0, 0}, {4, 0}, {5, -0.5}, {6, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (int i = 0; i < 7; ++i) bump.segments.push_back({i, (i + 1) % 7, 1});
  for (const bool seeded : {false, true}) {
    Pslg pslg = bump;
    if (seeded) pslg.regions = {{{5, -0.4}, 3, 0}};
    simplify(pslg, 1);
    CHECK(std::ranges::count(pslg.points, Point{5, -0.5}) == (seeded ? 1 : 0));
  }
}

TEST_CASE("small islands go with their seeds and lakes, all others stay") {
  Pslg pslg = circle(100, 10);
  add(pslg, circle(20, 0.4), {3, 0}, 2);   // an island
  add(pslg, circle(20, 0.1), {3, 0}, 3);   // with a lake
  add(pslg, circle(20, 0.6), {-3, 0}, 4);  // a larger one
  add(pslg, circle(20, 0.4), {0, 3}, 5);   // a small one with a town, which must not drown
  pslg.points.push_back({0, 3});
  pslg.holes = {{3.3, 0}, {-3, 0}, {0.2, 3}};
  pslg.regions = {{{3, 0}, 7, 0}, {{9, 0}, 8, 0}};
  const SimplifyReport report = simplify(pslg, 1);
  CHECK(report.rings == 2);
  CHECK(pslg.holes == std::vector<Point>{{-3, 0}, {0.2, 3}});
  REQUIRE(pslg.regions.size() == 1);
  CHECK(pslg.regions[0].attribute == 8);
  std::set<std::int32_t> markers;
  for (const auto& s : pslg.segments) markers.insert(s.marker);
  CHECK(markers == std::set<std::int32_t>{1, 4, 5});

  Pslg all = circle(100, 1);
  CHECK_THROWS_AS(simplify(all, 3), InputError);
  CHECK(all.points.size() == 100);
  CHECK_THROWS_AS(simplify(all, -1), Error);
  CHECK_THROWS_AS(simplify(all, NAN), Error);
}

TEST_CASE("ends, junctions and changes of markers stay") {
  // A line of 41 points along x with a branch at 20, another marker from 30 on, and a point with its own marker at 10.
  Pslg pslg;
  for (int i = 0; i <= 40; ++i) pslg.points.push_back({i * 1.0, 0.01 * (i % 2)});
  for (int i = 0; i < 40; ++i) pslg.segments.push_back({i, i + 1, i < 30 ? 1 : 2});
  pslg.points.push_back({20, 5});
  pslg.segments.push_back({20, 41, 1});
  pslg.point_markers.assign(42, 0);
  pslg.point_markers[10] = 9;
  const SimplifyReport report = simplify(pslg, 0.1);
  CHECK(report.original_point == std::vector<std::int32_t>{0, 9, 10, 11, 20, 30, 40, 41});
  CHECK(pslg.segments ==
        std::vector<Pslg::Segment>{{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 5, 1}, {5, 6, 2}, {4, 7, 1}});
}

TEST_CASE("a point next to the end of a line goes, though the line then comes a little closer to others") {
  // A coast that meets the frame of a map, where its marker changes, with one of its points just before.
  std::mt19937_64 random = seeded_generator("ends at frames");
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (std::int64_t tried = 0; more_cases(tried, 200, true); ++tried) {
    Pslg pslg;
    const double off = uniform(0.1, 5), angle = uniform(2, 4.2);
    pslg.points = {{-9000, 3000},
                   {uniform(-1500, -900), uniform(-400, 400)},
                   {off * std::cos(angle), off * std::sin(angle)},
                   {0, 0},
                   {0, -uniform(60, 240)},
                   {-1500, -900},
                   {-3000, -6000},
                   {-9000, -6000}};
    for (int k = 0; k < 8; ++k) pslg.segments.push_back({k, (k + 1) % 8, k == 0 ? 2 : k == 3 ? 3 : 1});
    CAPTURE(off);
    CAPTURE(angle);
    const SimplifyReport report = simplify(pslg, 1000);
    CHECK(std::ranges::find(report.original_point, 2) == report.original_point.end());
    CHECK(std::ranges::find(report.original_point, 4) != report.original_point.end());
  }
}
