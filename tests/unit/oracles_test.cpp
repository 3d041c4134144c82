#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "oracles/grid_mesh.hpp"
#include "oracles/mesh_faults.hpp"
#include "oracles/mesh_oracle.hpp"
#include "oracles/polygon_areas.hpp"
#include "oracles/random_polygons.hpp"
#include "oracles/random_pslg.hpp"
#include "verify/domain.hpp"

// The oracles detect errors.

using namespace driftmesh;
using namespace driftmesh::oracles;

namespace {

const std::vector<std::string> kRight;

Mesh kite(bool delaunay) {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, -1}, {4, 0}, {2, 1}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  if (delaunay)
    mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  else
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

TEST_CASE("the Delaunay oracle sees a vertex in a circle, unless a subsegment hides it") {
  CHECK(check_constrained_delaunay(kite(true)) == kRight);
  CHECK(check_constrained_delaunay(kite(false)).size() == 2);
  Mesh walled = kite(false);
  walled.edges.push_back({0, 2, 1});
  CHECK(check_constrained_delaunay(walled) == kRight);
}

TEST_CASE("the Delaunay oracle looks through gaps between subsegments") {
  // The eye at (0, -3) is in the circle of the triangle; two walls with a gap between them stand in the way.
  Mesh mesh;
  mesh.points = {{-3, 0}, {3, 0}, {0, 1}, {0, -3}, {-3, -1}, {-0.1, -1}, {0.1, -1}, {3, -1}};
  mesh.triangles = {{0, 1, 2}};
  CHECK(check_constrained_delaunay(mesh).size() == 5);
  mesh.edges = {{4, 5, 0}, {6, 7, 0}};
  const auto with_gap = check_constrained_delaunay(mesh);
  CHECK(std::count_if(with_gap.begin(), with_gap.end(),
                      [](const std::string& s) { return s.find("point 3 ") != std::string::npos; }) == 1);
  mesh.edges = {{4, 7, 0}};
  const auto without = check_constrained_delaunay(mesh);
  CHECK(std::count_if(without.begin(), without.end(),
                      [](const std::string& s) { return s.find("point 3 ") != std::string::npos; }) == 0);
}

TEST_CASE("area, coverage and covering oracles on a correct mesh and on damaged ones") {
  const GridCase right;
  const std::vector<bool> none(right.input.segments.size(), false);
  CHECK(find_boundary(right.mesh).size() == 64);
  CHECK(check_area(right.mesh, find_boundary(right.mesh)) == kRight);
  CHECK(check_coverage(right.mesh, right.input, 0, none) == kRight);
  CHECK(count_covering(right.mesh, {0.5, 0.25}) == 1);
  CHECK(count_covering(right.mesh, {5.5, 4.25}) == 0);
  CHECK(count_covering(right.mesh, {1, 1}) == -1);

  Mesh mesh = right.mesh;
  mesh.triangles.pop_back();
  CHECK(check_area(mesh, find_boundary(right.mesh)) != kRight);
  mesh = right.mesh;
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  CHECK(check_area(mesh, find_boundary(right.mesh)) != kRight);
  mesh = right.mesh;
  mesh.edges.erase(mesh.edges.begin() + 5);
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  mesh = right.mesh;
  mesh.edges.push_back(mesh.edges[5]);
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  mesh = right.mesh;
  ++mesh.edges[5].marker;
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  std::vector<bool> one = none;
  one.back() = true;
  CHECK(check_coverage(right.mesh, right.input, 0, one) != kRight);
}

TEST_CASE("random inputs are planar, and the arrangement finds the boundary that they were made with") {
  int inner = 0, points = 0, dangling = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const RandomPslg random = make_random_pslg(seed, make_random_shape(seed));
    const Domain domain(random.input);
    REQUIRE(!domain.conflict());
    std::size_t boundary = 0;
    for (const auto& s : domain.segments()) boundary += domain.inside(s.left_face) != domain.inside(s.right_face);
    CHECK(boundary == random.boundary_segments.size());
    for (const std::int32_t p : first_ids<std::int32_t>(domain.points().size())) CHECK(domain.point_inside(p));
    for (const auto& s : random.input.segments) inner += s.marker >= 100, dangling += s.marker == 50;
    points += random.input.points.size() > random.input.segments.size();
  }
  CHECK(inner > 100);
  CHECK(dangling > 50);
  CHECK(points > 50);
}

namespace {

double area_of(const std::vector<GridRing>& rings) {
  return static_cast<double>(covered_areas({{rings, {}}}).total);
}

}  // namespace

TEST_CASE("areas of polygons: holes that cross, overlap, leave and touch") {
  const GridRing square = rectangle(0, 0, 10, 10);
  CHECK(area_of({square}) == 100);
  CHECK(area_of({square, rectangle(5, 4, 14, 6)}) == 90);
  CHECK(area_of({square, rectangle(2, 4, 6, 8), rectangle(5, 3, 8, 7)}) == 75);
  CHECK(area_of({square, rectangle(20, 20, 30, 30)}) == 100);
  CHECK(area_of({square, rectangle(-1, -1, 11, 11)}) == 0);
  CHECK(area_of({square, square}) == 0);
  CHECK(area_of({rectangle(0, 0, 20, 25), {{2, 12}, {4, 23}, {5, 23}}, {{2, 12}, {6, 23}, {7, 23}}}) == 489);
  CHECK(area_of({square, rectangle(2, 2, 4, 4), rectangle(4, 4, 6, 6)}) == 92);
}

TEST_CASE("areas of rings by even-odd: crossings, spikes, pockets and keyholes") {
  CHECK(area_of({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}) == 50);
  CHECK(area_of({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 7}, {5, 7}, {5, 3}, {0, 3}, {0, 7}, {0, 3}}}) == 80);
  CHECK(area_of({{{0, 0}, {10, 0}, {10, 10}, {5, 10}, {7, 5}, {3, 5}, {5, 10}, {0, 10}}}) == 90);
  CHECK(area_of({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {4, 4}, {4, 6}, {6, 6}, {6, 4}, {4, 4}}}) == 96);
  CHECK(area_of({{{0, 0}, {10, 0}, {15, 5}, {10, 0}, {10, 10}, {0, 10}}}) == 100);
  CHECK(area_of({{{0, 0}, {10, 0}, {5, 0}}}) == 0);
  CHECK(area_of({{{3, 3}}}) == 0);
  CHECK(area_of({rectangle(0, 0, 4, 4), {}}) == 16);
  CHECK(area_of({{{0, 0}, {3, 1}, {1, 3}}}) == 4);
  CHECK(static_cast<double>(covered_areas({{{{{0, 0}, {3, 1}, {0, 1}, {3, 0}}}, {}}}).total) == 1.5);
}

TEST_CASE("areas of sets of polygons, and of regions where they overlap") {
  const GridPolygon one{{rectangle(4, 4, 11, 10), rectangle(5, 7, 10, 9)}, {}}, other{{rectangle(4, 5, 8, 12)}, {}};
  CHECK(covered_areas({one, other}).total == 46);
  GridPolygon first{{rectangle(0, 0, 6, 6)}, 1}, second{{rectangle(3, 3, 9, 9)}, 2};
  PolygonAreas areas = covered_areas({first, second});
  CHECK(areas.total == 63);
  CHECK(areas.regions == std::map<double, long double>{{1, 27}, {2, 36}});
  areas = covered_areas({second, first});
  CHECK(areas.regions == std::map<double, long double>{{1, 36}, {2, 27}});
  second.region.reset();  // says nothing
  areas = covered_areas({first, second});
  CHECK(areas.regions == std::map<double, long double>{{0, 27}, {1, 36}});
  CHECK(covered_areas({}).total == 0);
}

TEST_CASE("areas far from the origin, up to coordinates of 2^52") {
  for (const std::int64_t shift :
       {std::int64_t{0}, std::int64_t{1} << 20, std::int64_t{1} << 40, (std::int64_t{1} << 52) - 20}) {
    const GridRing outer = rectangle(shift, -shift, shift + 10, 10 - shift);
    const GridRing crossing{{shift + 5, 1 - shift}, {shift + 15, 1 - shift}, {shift + 5, 11 - shift}};
    CHECK(area_of({outer, crossing}) == 63);
  }
}

TEST_CASE("areas do not depend on where rings begin, their direction, and a turn of the plane") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomPolygons set = make_random_polygons(seed);
    const PolygonAreas areas = covered_areas(set.polygons);
    for (GridPolygon& polygon : set.polygons)
      for (GridRing& ring : polygon.rings) {
        std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(seed % ring.size()), ring.end());
        if (seed % 2 == 0) std::reverse(ring.begin(), ring.end());
        for (GridPoint& p : ring) p = {-p.y, p.x};
      }
    const PolygonAreas turned = covered_areas(set.polygons);
    CAPTURE(seed);
    CHECK(static_cast<double>(turned.total) == doctest::Approx(static_cast<double>(areas.total)).epsilon(1e-12));
    CHECK(turned.regions.size() == areas.regions.size());
    for (const auto& [region, area] : areas.regions)
      CHECK(static_cast<double>(turned.regions.at(region)) ==
            doctest::Approx(static_cast<double>(area)).epsilon(1e-12));
  }
}

TEST_CASE("faults of meshes") {
  const GridCase grid;
  CHECK(fault_of(grid.mesh, grid.input, grid.mesh).what == "");
  const auto fault = [&](auto&& damage) {
    GridCase damaged;
    damage(damaged);
    return fault_of(damaged.mesh, grid.input, grid.mesh).what;
  };
  CHECK(fault([](GridCase& g) { g.mesh.triangles.pop_back(); }) == "an array of the wrong length");
  CHECK(fault([](GridCase& g) { g.mesh.triangles[3][1] = -1; }) == "a triangle of other points");
  CHECK(fault([](GridCase& g) { g.mesh.points[5] = g.mesh.points[4]; }).find("lies on another") != std::string::npos);
  CHECK(fault([](GridCase& g) { std::swap(g.mesh.triangles[3][1], g.mesh.triangles[3][2]); }) ==
        "triangle 3 is not counterclockwise");
  CHECK(fault([](GridCase& g) { g.mesh.points[g.at(2, 2)].x += 1e-15; }).find("Delaunay") != std::string::npos);
  CHECK(fault([](GridCase& g) { g.mesh.edges[0].marker = 9; }).find("marker") != std::string::npos);
  CHECK(fault([](GridCase& g) { g.mesh.edges.pop_back(); }).find("not covered") != std::string::npos);
  CHECK(fault([](GridCase& g) { g.mesh.regions[7] = 9; }).find("region") != std::string::npos);
}
