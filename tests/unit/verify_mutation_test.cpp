#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "damaged_grid.hpp"
#include "verify/report_text.hpp"

// Each test damages a correct mesh in one way and expects the corresponding kind of flaw. Flaws of the mesh itself are
// here; those of a mesh and its input are in verify_input_test.cpp.

using namespace driftmesh;
using namespace driftmesh::testing;
using oracles::GridCase;

TEST_CASE("a correct mesh is accepted, with and without its input") {
  const GridCase grid;
  const VerifyReport report = check(grid);
  INFO(all_messages(report));
  CHECK(report.accepted());
  CHECK(report.triangles == 256);
  CHECK(report.unused_points == 0);
  CHECK(report.boundary_edges == 64);
  CHECK(report.area == 128);
  CHECK(report.input_area == 128);
  CHECK(report.quality.smallest_angle == doctest::Approx(45));
  CHECK(report.quality.largest_angle == doctest::Approx(90));
  CHECK(report.quality.largest_area == 0.5);
  CHECK(verify(grid.mesh, {}).accepted());
}

TEST_CASE("arrays of the wrong length") {
  GridCase grid;
  grid.mesh.regions.pop_back();
  CHECK_ONLY(check(grid), Flaw::kBadArray);
  grid = GridCase();
  grid.mesh.point_markers.pop_back();
  CHECK_ONLY(check(grid), Flaw::kBadArray);
  grid = GridCase();
  grid.mesh.attributes.push_back(1);
  CHECK_ONLY(check(grid), Flaw::kBadArray);
}

TEST_CASE("a negative number of attributes") {
  GridCase grid;
  grid.mesh.attributes_per_point = -1;
  CHECK_ONLY(check(grid), Flaw::kBadArray);
}

TEST_CASE("neighbors that coincide, with subsegments and without") {
  for (const Point& other : {Point{2, 2}, Point{-2, 2}, Point{0, 2}, Point{2, 0}})
    for (std::size_t k = 0; k < 3; ++k)
      for (const bool listed : {false, true}) {
        Mesh mesh;
        mesh.points.assign(3, {0, 0});
        mesh.points[k] = other;
        mesh.triangles = {{0, 1, 2}};
        if (listed) mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
        const VerifyReport report = verify(mesh, {});
        CHECK(report.findings.count(Flaw::kNotCounterclockwise) == 1);
        CHECK(report.findings.count(Flaw::kDuplicatePoint) == 1);
        CHECK(report.quality.smallest_area == 0);
        mesh.points.assign(3, other);
        CHECK_HAS(verify(mesh, {}), Flaw::kDuplicatePoint);
      }
}

TEST_CASE("each point of the boundary moved onto each other one") {
  const GridCase grid;
  for (const auto& [a, b, marker] : grid.mesh.edges)
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      GridCase moved;
      moved.mesh.points[from] = grid.mesh.points[to];
      CHECK_HAS(check(moved), Flaw::kDuplicatePoint);
      CHECK_HAS(verify(moved.mesh, {}), Flaw::kDuplicatePoint);
    }
}

TEST_CASE("a point of the inside moved onto another one") {
  const GridCase grid;
  for (const auto& [from, to] : {std::pair(grid.at(2, 2), grid.at(3, 2)), std::pair(grid.at(10, 5), grid.at(2, 11))}) {
    GridCase moved;
    moved.mesh.points[from] = grid.mesh.points[to];
    CHECK(check(moved).findings.count(Flaw::kDuplicatePoint) == 1);
    CHECK(verify(moved.mesh, {}).findings.count(Flaw::kDuplicatePoint) == 1);
  }
}

TEST_CASE("a triangle far beyond the domain does not take forever where sizes are asked for") {
  struct NoLimit : SizeField {
    [[nodiscard]] double edge_length(const Point&) const override { return std::numeric_limits<double>::infinity(); }
  };
  const NoLimit field;
  GridCase grid;
  grid.mesh.points[grid.at(2, 2)] = {1e60, 2};
  const VerifyReport report =
      verify(grid.mesh, grid.input, {.plain = {.region_areas = false}, .size = &field, .size_spacing = 0.1});
  CHECK(report.findings.count(Flaw::kNotCounterclockwise) > 0);
}

TEST_CASE("indices that name a missing point, or the same point twice") {
  GridCase grid;
  grid.mesh.triangles[7][1] = static_cast<std::int32_t>(grid.mesh.points.size());
  CHECK_ONLY(check(grid), Flaw::kBadIndex);
  grid = GridCase();
  grid.mesh.triangles[7][1] = -1;
  CHECK_ONLY(check(grid), Flaw::kBadIndex);
  grid = GridCase();
  grid.mesh.triangles[7][1] = grid.mesh.triangles[7][0];
  CHECK_ONLY(check(grid), Flaw::kBadIndex);
  grid = GridCase();
  grid.mesh.edges[3].b = -7;
  CHECK_ONLY(check(grid), Flaw::kBadIndex);
}

TEST_CASE("coordinates outside the range of the predicates") {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e-300}) {
    GridCase grid;
    grid.mesh.points[5].x = bad;
    CHECK_ONLY(check(grid), Flaw::kBadCoordinate);
  }
}

TEST_CASE("an inverted triangle") {
  GridCase grid;
  std::swap(grid.mesh.triangles[40][0], grid.mesh.triangles[40][1]);
  CHECK_HAS(check(grid), Flaw::kNotCounterclockwise);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::kNotCounterclockwise);
}

TEST_CASE("a vertex moved across an edge inverts a triangle; moved a little it breaks Delaunay") {
  GridCase grid;
  grid.mesh.points[grid.at(2, 2)] = {3.5, 2};
  CHECK_HAS(check(grid), Flaw::kNotCounterclockwise);
  grid = GridCase();
  grid.mesh.points[grid.at(2, 2)] = {2.25, 2.125};
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::kNotDelaunay);
}

TEST_CASE("a Steiner vertex moved by one unit in the last place breaks an exact cocircularity") {
  GridCase grid;
  grid.mesh.points[grid.at(2, 2)].x = std::nextafter(2.0, 3.0);
  CHECK_ONLY(check(grid, 0, 0), Flaw::kNotDelaunay);
}

TEST_CASE("an edge flipped against Delaunay") {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, -1}, {4, 0}, {2, 1}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  CHECK(verify(mesh, {}).accepted());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  CHECK_ONLY(verify(mesh, {}), Flaw::kNotDelaunay);
  mesh.edges.push_back({0, 2, 1});  // a constrained edge need not be Delaunay
  CHECK(verify(mesh, {}).accepted());
}

TEST_CASE("a missing triangle") {
  GridCase grid;
  drop_triangle(grid.mesh, find_triangle(grid.mesh, {grid.at(10, 10), grid.at(11, 10), grid.at(11, 11)}));
  CHECK_HAS(check(grid), Flaw::kOpenEdge);
  CHECK_HAS(check(grid), Flaw::kWrongArea);
  CHECK_HAS(check(grid), Flaw::kWrongEuler);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::kOpenEdge);
}

TEST_CASE("a triangle listed twice") {
  GridCase grid;
  add_triangle(grid.mesh, grid.mesh.triangles[33], 10);
  CHECK_HAS(check(grid), Flaw::kDuplicateTriangle);
  GridCase turned;
  const auto [a, b, c] = turned.mesh.triangles[33];
  add_triangle(turned.mesh, {b, c, a}, 10);
  CHECK_HAS(check(turned), Flaw::kDuplicateTriangle);
}

TEST_CASE("a third triangle on an edge") {
  GridCase grid;
  const std::int32_t far = grid.at(10, 5);
  add_triangle(grid.mesh, {grid.at(0, 2), grid.at(1, 2), far}, 10);
  CHECK_HAS(check(grid), Flaw::kEdgeUsedTwice);
}

TEST_CASE("a point that no triangle uses is counted, but is not a flaw") {
  GridCase grid;
  add_point(grid.mesh, {1.5, 1.25});
  CHECK(check(grid).accepted());
  CHECK(check(grid).unused_points == 1);
  add_point(grid.mesh, {0, 0});  // nor is it where another point is
  add_point(grid.mesh, {2, 2});
  CHECK(check(grid).accepted());
  CHECK(check(grid).unused_points == 3);
  grid.mesh.regions[17] = 20;
  CHECK_ONLY(check(grid), Flaw::kWrongRegion);
}

TEST_CASE("a vertex in an edge: a T-junction") {
  GridCase grid;
  // Cut the triangle on one side of the edge (2,2)-(3,2), but not the one on the other.
  const std::int32_t a = grid.at(2, 2), b = grid.at(3, 2), c = grid.at(3, 3);
  const std::int32_t m = add_point(grid.mesh, {2.5, 2});
  grid.mesh.triangles[find_triangle(grid.mesh, {a, b, c})] = {a, m, c};
  add_triangle(grid.mesh, {m, b, c}, 10);
  CHECK_HAS(check(grid), Flaw::kOpenEdge);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::kOpenEdge);
  // Declared as a slit of constrained edges, it is still detected: the boundary touches itself.
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{a, m, 0}, {m, b, 0}, {a, b, 0}});
  CHECK_HAS(verify(grid.mesh, {}), Flaw::kBoundaryCrosses);
}

TEST_CASE("a crack between two copies of a point") {
  GridCase grid;
  const std::int32_t old = grid.at(0, 5), copy = add_point(grid.mesh, {0, 5});
  const std::int32_t above = grid.at(0, 6);
  for (auto& triangle : grid.mesh.triangles)
    if (std::find(triangle.begin(), triangle.end(), above) != triangle.end())
      std::replace(triangle.begin(), triangle.end(), old, copy);
  CHECK_HAS(check(grid), Flaw::kDuplicatePoint);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::kDuplicatePoint);
}

TEST_CASE("two sheets over the same place") {
  GridCase grid;
  // A second copy of the whole mesh, shifted by half a cell: each sheet is a triangulation of its own.
  const Mesh sheet = grid.mesh;
  const auto shift = static_cast<std::int32_t>(sheet.points.size());
  for (const Point& p : sheet.points) add_point(grid.mesh, {p.x + 0.5, p.y + 0.25});
  for (const auto& [a, b, c] : sheet.triangles) add_triangle(grid.mesh, {a + shift, b + shift, c + shift}, 10);
  for (const auto& [a, b, marker] : sheet.edges) grid.mesh.edges.push_back({a + shift, b + shift, marker});
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::kBoundaryCrosses);
}

TEST_CASE("a sheet inside another one, no edges crossing") {
  GridCase grid;
  const std::int32_t a = add_point(grid.mesh, {1.25, 1.125}), b = add_point(grid.mesh, {1.75, 1.125}),
                     c = add_point(grid.mesh, {1.5, 1.25});
  add_triangle(grid.mesh, {a, b, c}, 10);
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{a, b, 1}, {b, c, 1}, {c, a, 1}});
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::kOverlap);
}

TEST_CASE("triangles that wind twice around a vertex") {
  Mesh mesh;
  mesh.points.push_back({0, 0});
  for (int i = 0; i < 10; ++i) {
    const double angle = i * 0.4 * 3.14159265358979, radius = i < 5 ? 1 : 1.25;
    mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    mesh.triangles.push_back({0, i + 1, (i + 1) % 10 + 1});
    mesh.edges.push_back({i + 1, (i + 1) % 10 + 1, 1});
  }
  const VerifyReport report = verify(mesh, {});
  INFO(all_messages(report));
  CHECK((report.findings.count(Flaw::kBoundaryCrosses) > 0 || report.findings.count(Flaw::kOverlap) > 0));
}

TEST_CASE("a closed ring and another fan at one vertex") {
  GridCase grid;
  const std::int32_t hub = grid.at(2, 2);
  const std::int32_t p = add_point(grid.mesh, {2.25, 2.0625}), q = add_point(grid.mesh, {2.25, 2.125});
  add_triangle(grid.mesh, {hub, p, q}, 10);
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{hub, p, 1}, {p, q, 1}, {q, hub, 1}});
  CHECK_HAS(check(grid), Flaw::kTangledVertex);
}

TEST_CASE("interfaces are counted where triangles are far from cocircular") {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}};
  for (std::int32_t i = 0; i < 6; ++i) mesh.triangles.push_back({0, i + 1, (i + 1) % 6 + 1});
  mesh.subdomains = {0, 0, 0, 1, 1, 2};
  mesh.ranks = {7, 7, 7, 7, 7, 8};
  const VerifyReport report = verify(mesh, {});
  CHECK(report.accepted());
  CHECK(report.subdomains == 3);
  CHECK(report.interfaces == 3);
  CHECK(report.interface_edges == 3);
  CHECK(report.interface_edges_not_delaunay == 0);
  CHECK(report.rank_interface_edges == 2);
}

TEST_CASE("each thread tells of the flaws inside its part") {
  const auto flaws = [](const std::vector<std::pair<int, int>>& moved, std::size_t threads) {
    GridCase grid;
    for (const auto& [x, y] : moved) grid.mesh.points[grid.at(x, y)] = {x + 0.25, y + 0.125};
    const VerifyReport report = verify(grid.mesh, {.threads = threads});
    CHECK_ONLY(report, Flaw::kNotDelaunay);
    return report.findings.count(Flaw::kNotDelaunay);
  };
  const std::uint64_t here = flaws({{2, 2}}, 1);  // all is the same around (10, 10), near the end of the points
  for (const std::size_t threads : {1, 2, 3}) {
    CHECK(flaws({{2, 2}}, threads) == here);
    CHECK(flaws({{10, 10}}, threads) == here);
    CHECK(flaws({{2, 2}, {10, 10}}, threads) == 2 * here);
  }
}

TEST_CASE("the report does not depend on the number of threads") {
  std::mt19937 random(5);
  for (int round = 0; round < 60; ++round) {
    const Mesh mesh = randomly_damaged(random);
    VerifyOptions options{.min_angle = 30, .plain = {.area = 0.4}};
    const VerifyReport alone = verify(mesh, options);
    for (const std::size_t threads : {2, 3, round == 0 ? 300 : 7}) {
      options.threads = threads;
      const VerifyReport report = verify(mesh, options);
      CHECK(report_text(report, options) == report_text(alone, options));
      CHECK(report.quality.smallest_angle_triangle == alone.quality.smallest_angle_triangle);
      CHECK(report.quality.largest_angle_triangle == alone.quality.largest_angle_triangle);
      CHECK(report.quality.largest_area_triangle == alone.quality.largest_area_triangle);
    }
  }
}
