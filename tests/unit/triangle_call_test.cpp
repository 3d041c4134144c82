#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "triangle/derived.hpp"
#include "triangle/old_mesh.hpp"
#include "triangle/switches.hpp"
#include "triangle/triangulate.hpp"

// What Triangle's call makes of tables, piece by piece. The calls that users have are tested in Python and C.

using namespace driftmesh;
using namespace driftmesh::triangle;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A square of two triangles, the second of which is clockwise, and a point outside.
Tables two_triangles() {
  Tables mesh;
  mesh.points = {{9, 9}, {0, 0}, {2, 0}, {2, 2}, {0, 2}};
  mesh.triangles = {1, 2, 3, 1, 4, 3};
  return mesh;
}

Tables square(double size) {
  Tables input;
  input.points = {{0, 0}, {size, 0}, {size, size}, {0, size}};
  input.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return input;
}

double area_of(const Tables& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    area += signed_area(mesh.points[static_cast<std::size_t>(mesh.triangles[3 * t])],
                        mesh.points[static_cast<std::size_t>(mesh.triangles[3 * t + 1])],
                        mesh.points[static_cast<std::size_t>(mesh.triangles[3 * t + 2])]);
  return area;
}

}  // namespace

TEST_CASE("points of the Voronoi diagram have the values of a linear function") {
  Tables mesh;
  mesh.points = {{0, 0}, {3, 0.5}, {1, 2}};
  mesh.triangles = {0, 1, 2};
  mesh.attributes_per_point = 2;
  for (const Point& p : mesh.points)
    mesh.point_attributes.insert(mesh.point_attributes.end(), {2 * p.x - p.y + 1, p.y});
  add_edges(mesh);
  const Voronoi voronoi = voronoi_of(mesh);
  REQUIRE(voronoi.points.size() == 1);
  const Point& center = voronoi.points.front();
  CHECK(voronoi.point_attributes[0] == doctest::Approx(2 * center.x - center.y + 1));
  CHECK(voronoi.point_attributes[1] == doctest::Approx(center.y));
}

TEST_CASE("markers and segments go with points when others are left out") {
  Tables mesh;
  mesh.points = {{9, 9}, {0, 0}, {8, 8}, {1, 0}, {0, 1}};
  mesh.point_markers = {7, 1, 8, 2, 3};
  mesh.triangles = {1, 3, 4};
  mesh.segments = {{1, 3}, {3, 4}};
  jettison_points(mesh);
  CHECK(mesh.points == std::vector<Point>{{0, 0}, {1, 0}, {0, 1}});
  CHECK(mesh.point_markers == std::vector{1, 2, 3});
  CHECK(mesh.triangles == std::vector{0, 1, 2});
  CHECK(mesh.segments == std::vector<Pair>{{0, 1}, {1, 2}});
}

TEST_CASE("an old mesh may have clockwise triangles, and segments beside it") {
  Tables tables = two_triangles();
  tables.segments = {{1, 3}, {0, 3}, {3, 0}};
  tables.segment_markers = {5, 6, 7};
  const OldMesh old(tables);
  CHECK(old.triangle_at({1.5, 0.5}) == 0);
  CHECK(old.triangle_at({0.5, 1.5}) == 1);
  CHECK(old.triangle_at({3, 3}) == -1);
  CHECK(old.triangle_at({1, 1}) == 1);
  const Pslg domain = old.domain(true);
  CHECK(domain.points == std::vector<Point>{{0, 0}, {2, 0}, {2, 2}, {0, 2}});
  CHECK(domain.segments.size() == 5);
  CHECK(domain.segments.front().marker == 5);
  for (const Pslg::Segment& s : domain.segments) CHECK(std::min(s.a, s.b) >= 0);
  CHECK(std::ranges::count(domain.segments, 0, &Pslg::Segment::marker) == 4);
}

TEST_CASE("on the border of two old triangles the larger bound counts, or none") {
  const Tables tables = two_triangles();
  const OldMesh old(tables);
  const auto length = [&](std::vector<double> areas, const Point& p) { return AreaField(old, areas).edge_length(p); };
  const double small = length({0.01, 1}, {1.5, 0.5}), large = length({0.01, 1}, {0.5, 1.5});
  CHECK(large == doctest::Approx(10 * small));
  CHECK(length({0.01, 1}, {1, 1}) == large);
  CHECK(length({1, 0.01}, {1, 1}) == large);
  CHECK(length({0, 0.01}, {1.5, 0.5}) == kInfinity);
  CHECK(length({0, 0.01}, {1, 1}) == kInfinity);
  CHECK(length({1, 1}, {3, 3}) == kInfinity);
}

TEST_CASE("what is not asked for is not returned") {
  const auto made = [](const char* switches) { return triangulate(square(1), parse_switches(switches)).mesh; };
  CHECK(made("p").neighbors.empty());
  CHECK(made("pn").neighbors.size() == 2);
  CHECK(made("pe").edges.size() == 5);
  CHECK(made("pe").edge_markers.size() == 5);
  CHECK(made("peB").edges.size() == 5);
  CHECK(made("peB").edge_markers.empty());
}

TEST_CASE("holes are filled on request") {
  Tables input = square(3);
  for (const Point& p : square(1).points) input.points.push_back({p.x + 1, p.y + 1});
  for (const Pair& s : square(1).segments) input.segments.push_back({s[0] + 4, s[1] + 4});
  input.holes = {{1.5, 1.5}};
  CHECK(area_of(triangulate(input, parse_switches("p")).mesh) == doctest::Approx(8));
  CHECK(area_of(triangulate(input, parse_switches("pO")).mesh) == doctest::Approx(9));
}

TEST_CASE("what a caller finds unsuitable is split, and no more than that") {
  std::int64_t asked = 0;
  const Caller caller{.unsuitable = [&](const Point&, const Point&, const Point&, double area) {
    ++asked;
    return area > 1e-3;
  }};
  const Tables mesh = triangulate(square(1), parse_switches("pu"), caller).mesh;
  const auto triangles = static_cast<std::int64_t>(mesh.triangle_count());
  CHECK(triangles > 1000);
  CHECK(triangles < 1300);
  CHECK(asked < 3 * triangles);
}

TEST_CASE("many points by themselves get no others") {
  Tables input;
  for (int i = 0; i < 300; ++i)
    for (int j = 0; j < 300; ++j) input.points.push_back({std::sin(i + 0.3 * j), std::cos(3.1 * j - i)});
  CHECK(triangulate(input, parse_switches("")).mesh.points.size() == input.points.size());
}
