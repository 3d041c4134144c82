#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/polygon_cover.hpp"
#include "mesh/with_seeds.hpp"
#include "support/warnings_of.hpp"

using namespace driftmesh;
using testing::warnings_of;

namespace {

using Corners = std::vector<Point>;

std::int32_t number(Pslg& pslg, const Point& p) {
  const auto known = std::ranges::find(pslg.points, p);
  if (known == pslg.points.end()) {
    pslg.points.push_back(p);
    return static_cast<std::int32_t>(pslg.points.size()) - 1;
  }
  return static_cast<std::int32_t>(known - pslg.points.begin());
}

void add(Pslg& pslg, const std::vector<Corners>& rings, std::int32_t region = -1, std::int32_t feature = 0) {
  Pslg::Polygon& polygon = pslg.polygons.emplace_back();
  polygon.region = region;
  polygon.feature = feature > 0 ? feature : static_cast<std::int32_t>(pslg.polygons.size());
  for (const Corners& corners : rings) {
    Pslg::Ring& ring = polygon.rings.emplace_back();
    for (const Point& p : corners) ring.push_back(number(pslg, p));
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const std::int32_t next = ring[(i + 1) % ring.size()]; next != ring[i])
        pslg.segments.push_back({ring[i], next, static_cast<std::int32_t>(polygon.rings.size())});
  }
}

Pslg one(const std::vector<Corners>& rings) {
  Pslg pslg;
  add(pslg, rings);
  return pslg;
}

double covered_area(const Triangulation& mesh, int label = -1) {
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && (label < 0 || mesh.region[t] == label))
      area += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return area;
}

double area(Pslg pslg) {
  static_cast<void>(repair(pslg));
  const double area = covered_area(triangulate(pslg));
  CHECK(covered_area(triangulate(with_seeds(pslg))) == doctest::Approx(area));
  return area;
}

/// The only warning about an input.
std::string warning(const Pslg& pslg) {
  const std::vector<std::string> all = warnings_of(pslg);
  REQUIRE(all.size() == 1);
  return all[0];
}

const Corners kPlate{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

Corners box(double x, double y, double w, double h) {
  return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
}

}  // namespace

TEST_CASE("holes over the edge of their polygon, or over each other") {
  const Pslg crosses = one({kPlate, box(5, 4, 9, 2)});
  CHECK(area(crosses) == doctest::Approx(90));
  CHECK(warning(crosses) == "a hole of feature 1 reaches outside its first ring, where it removes nothing, at (" +
                                warning(crosses).substr(warning(crosses).rfind('(') + 1));
  const Pslg overlap = one({kPlate, box(2, 4, 4, 4), box(5, 3, 3, 4)});
  CHECK(area(overlap) == doctest::Approx(75));
  CHECK(warning(overlap).find("holes of feature 1 overlap at (5.") == 0);
  const Pslg shared = one({kPlate, box(2, 2, 3, 3), box(5, 2, 3, 3)});
  CHECK(area(shared) == doctest::Approx(82));
  CHECK(warning(shared) == "ring 3 of feature 1 shares an edge with ring 2 at (5, 3.5)");
  const Pslg at_the_edge = one({kPlate, box(0, 4, 5, 2)});
  CHECK(area(at_the_edge) == doctest::Approx(90));
  CHECK(warning(at_the_edge) == "ring 2 of feature 1 shares an edge with the first at (0, 5)");
}

TEST_CASE("a polygon over the hole of another, and holes that touch at a point, are as they should be") {
  Pslg over = one({box(4, 4, 7, 6), box(5, 7, 5, 2)});
  add(over, {box(4, 5, 4, 7)});
  CHECK(area(over) == doctest::Approx(46));
  CHECK(warnings_of(over).empty());
  const Pslg touching = one({box(0, 0, 20, 25), {{2, 12}, {4, 23}, {5, 23}}, {{2, 12}, {6, 23}, {7, 23}}});
  CHECK(area(touching) == doctest::Approx(489));
  CHECK(warnings_of(touching).empty());
}

TEST_CASE("rings that touch, cross or repeat themselves enclose what is inside an odd number of times") {
  const Pslg pocket = one({{{0, 0}, {10, 0}, {10, 10}, {5, 10}, {7, 5}, {3, 5}, {5, 10}, {0, 10}}});
  CHECK(area(pocket) == doctest::Approx(90));
  CHECK(warnings_of(pocket).empty());
  const Pslg clipped = one({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 7}, {5, 7}, {5, 3}, {0, 3}, {0, 7}, {0, 3}}});
  CHECK(area(clipped) == doctest::Approx(80));
  CHECK(warning(clipped) ==
        "the first ring of feature 1 runs more than once along one edge, which counts only if their number is odd, at "
        "(0, 5)");
  const Pslg keyhole = one({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {4, 4}, {4, 6}, {6, 6}, {6, 4}, {4, 4}}});
  CHECK(area(keyhole) == doctest::Approx(96));
  const Pslg bow = one({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}});
  CHECK(area(bow) == doctest::Approx(50));
  CHECK(warning(bow).find("the first ring of feature 1 crosses itself") == 0);
  const Pslg twice = one({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {6, 0}, {6, 6}, {0, 6}}});
  CHECK(area(twice) == doctest::Approx(64));
}

TEST_CASE("snapping takes spikes and slits off rings, which stay chains of segments") {
  const auto snapped = [](Pslg pslg) {
    static_cast<void>(repair(pslg, "input", {.snap = 0.1}));
    Pslg again = pslg;
    CHECK_FALSE(repair(again, "input", {.snap = 0.1}).changed());
    CHECK(again.polygons == pslg.polygons);
    return pslg;
  };
  // A spike to the right, wherever the ring begins.
  const Corners spiked{{0, 0}, {10, 0}, {10, 5}, {13, 5.02}, {10, 5.04}, {10, 10}, {0, 10}};
  for (std::size_t first = 0; first < spiked.size(); ++first) {
    CAPTURE(first);
    Corners turned = spiked;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    const Pslg found = snapped(one({turned}));
    CHECK(area(found) == doctest::Approx(100).epsilon(0.01));
    for (const Point& p : found.points) CHECK(p.x <= 10.1);
  }
  // A slit is closed, a thin hole goes, and so does a thin polygon.
  CHECK(area(snapped(one({{{0, 0}, {10, 0}, {10, 5}, {4, 5}, {10, 5.05}, {10, 10}, {0, 10}}}))) ==
        doctest::Approx(100).epsilon(0.01));
  CHECK(area(snapped(one({kPlate, box(2, 4, 5, 0.05)}))) == doctest::Approx(100).epsilon(0.01));
  Pslg beside = one({kPlate});
  add(beside, {box(20, 0, 5, 0.05)});
  const Pslg found = snapped(beside);
  CHECK(area(found) == doctest::Approx(100).epsilon(0.01));
  CHECK(found.points.size() == 4);
}

TEST_CASE("a convex hull in place of polygons is refused") {
  Pslg square = one({kPlate});
  CHECK_THROWS_WITH_AS(static_cast<void>(repair(square, "x", {.hull = true})),
                       "x: has polygons, which are the domain, and a convex hull would be another; leave out the hull, "
                       "or give the outline as lines",
                       InputError);
}

TEST_CASE("polygons that overlap are one domain, in the region of the last that has one") {
  Pslg two;
  two.regions = {{{}, 5, 0}, {{}, 6, 0}};
  add(two, {kPlate}, 0);
  add(two, {box(5, 0, 10, 10)}, 1);
  add(two, {box(0, 0, 1, 10)});
  const std::string expected = "feature 1 and feature 2 overlap at (";
  CHECK(warning(two).substr(0, expected.size()) == expected);
  static_cast<void>(repair(two));
  const Triangulation mesh = triangulate(two);
  CHECK(covered_area(mesh, 0) == 0);
  CHECK(covered_area(mesh, 1) == doctest::Approx(50));
  CHECK(covered_area(mesh, 2) == doctest::Approx(100));
  const Triangulation seeded = triangulate(with_seeds(two));
  CHECK(covered_area(seeded) == doctest::Approx(150));

  Pslg parts;
  add(parts, {kPlate}, -1, 7);
  add(parts, {box(5, 0, 10, 10)}, -1, 7);
  CHECK(warning(parts).find("polygons of feature 7 overlap at (") == 0);
  parts.polygons[1].feature = 8;
  CHECK(warnings_of(parts).empty());
}

TEST_CASE("lines bound nothing where there are polygons, and seeds apply besides") {
  Pslg pslg = one({kPlate});
  add(pslg, {box(20, 0, 10, 10)});
  for (const Corners& line : {Corners{{10, 0}, {20, 0}}, Corners{{10, 10}, {20, 10}}, Corners{{2, 0}, {2, 10}}})
    pslg.segments.push_back({number(pslg, line[0]), number(pslg, line[1]), 5});
  CHECK(area(pslg) == doctest::Approx(200));
  CHECK(warning(pslg).find("2 segments bound no part of the domain") == 0);
  pslg.holes = {{1, 1}, {15, 5}};
  CHECK(area(pslg) == doctest::Approx(180));
  pslg.regions = {{{5, 5}, 3, 0}};
  static_cast<void>(repair(pslg));
  CHECK(covered_area(triangulate(pslg), 1) == doctest::Approx(80));
}

TEST_CASE("a polygon that covers nothing is warned of, and refused if nothing else is there") {
  Pslg pslg = one({box(2, 2, 2, 2), box(0, 0, 9, 9)});
  Pslg alone = pslg;
  static_cast<void>(repair(alone));
  CHECK_THROWS_WITH_AS((void)triangulate(alone), doctest::Contains("cover no area"), Error);
  add(pslg, {box(20, 20, 5, 5)});
  CHECK(area(pslg) == doctest::Approx(25));
  const std::vector<std::string> warnings = warnings_of(pslg);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[1] == "feature 1 at (2, 2) covers no area");
}

TEST_CASE("rings follow their segments when these are split and their points are merged") {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {4, 0}, {2, 0}, {2, 9}};
  pslg.segments = {{0, 1, 1}, {4, 2, 1}, {2, 3, 1}, {3, 0, 1}, {5, 6, 2}, {1, 4, 1}};
  pslg.polygons = {{{{0, 1, 4, 2, 3}}, -1, 0}};
  static_cast<void>(repair(pslg));
  REQUIRE(pslg.polygons[0].rings[0].size() == 6);
  const Pslg::Ring ring = pslg.polygons[0].rings[0];
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::int32_t a = ring[i], b = ring[(i + 1) % ring.size()];
    CHECK(std::ranges::count_if(
              pslg.segments, [&](const Pslg::Segment& s) { return std::minmax(s.a, s.b) == std::minmax(a, b); }) == 1);
  }
  CHECK(area(pslg) == doctest::Approx(16));
}

TEST_CASE("rings that are not made of segments, and regions that do not exist, are refused") {
  Pslg pslg = one({kPlate});
  pslg.segments.pop_back();
  CHECK_THROWS_WITH_AS((void)repair(pslg), doctest::Contains("feature 1 has a ring with an edge that is no segment"),
                       InputError);
  pslg = one({kPlate});
  pslg.polygons[0].rings[0].push_back(4);
  CHECK_THROWS_WITH_AS((void)repair(pslg), doctest::Contains("names a vertex that does not exist"), InputError);
  pslg = one({kPlate});
  pslg.polygons[0].region = 0;
  CHECK_THROWS_WITH_AS((void)repair(pslg), doctest::Contains("names a region that does not exist"), InputError);
}

TEST_CASE("simplification takes corners from rings, and rings from polygons") {
  Pslg pslg;
  pslg.regions = {{{}, 1, 0}, {{5, 8}, 2, 0}, {{}, 3, 0}};
  add(pslg, {{{0, 0}, {5, 0.01}, {10, 0}, {10, 10}, {0, 10}}, box(4, 4, 0.1, 0.1)}, 2);
  add(pslg, {box(4, 4, 0.1, 0.1)}, 0);
  static_cast<void>(repair(pslg));
  static_cast<void>(simplify(pslg, 0.5));
  REQUIRE(pslg.polygons.size() == 1);
  CHECK(pslg.polygons[0].rings == std::vector<Pslg::Ring>{{0, 1, 2, 3}});
  REQUIRE(pslg.regions.size() == 2);
  CHECK(pslg.regions[0].attribute == 2);
  CHECK(pslg.regions[to_index(pslg.polygons[0].region)].attribute == 3);
  CHECK(area(pslg) == doctest::Approx(100));
}

// Rings around each other: outside, the first polygon, its hole, and the second polygon in that.
TEST_CASE("the flood decides by the rings that the walls belong to, whatever the order of the walls") {
  Pslg pslg = one({kPlate, box(2, 2, 6, 6)});
  add(pslg, {box(4, 4, 2, 2)});
  const auto wall = [](int outer, int inner) { return Wall{AreaId{inner}, AreaId{outer}}; };  // inner is left
  std::vector<Wall> walls;
  for (int ring = 0; ring < 3; ++ring)
    for (int side = 0; side < 4; ++side) walls.push_back(wall(ring, ring + 1));
  const PolygonCover cover = cover_by_polygons(pslg, walls, 4, AreaId{0});
  CHECK(cover.inside == IdVector<AreaId, bool>(std::vector<bool>{false, true, false, true}));
  CHECK(cover.flaws.empty());
  std::ranges::reverse(pslg.segments);
  std::ranges::reverse(walls);
  CHECK(cover_by_polygons(pslg, walls, 4, AreaId{0}).inside == cover.inside);
}

TEST_CASE("a ring whose points are merged into one covers nothing") {
  Pslg pslg = one({kPlate});
  pslg.points.insert(pslg.points.end(), {{20, 20}, {20, 20}, {20, 20 + 1e-15}});
  for (const auto& [a, b] : {std::pair(4, 5), std::pair(5, 6), std::pair(6, 4)}) pslg.segments.push_back({a, b, 1});
  pslg.polygons.push_back({{{4, 5, 6}}, -1, 2});
  CHECK(area(pslg) == doctest::Approx(100));
  CHECK(warning(pslg) == "feature 2 covers no area");
}
