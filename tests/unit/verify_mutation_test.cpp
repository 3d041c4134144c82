#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "oracles/grid_mesh.hpp"
#include "verify/verify.hpp"

// Each test damages a mesh that is right in one way and asks for the kind of flaw that names it.

using namespace driftmesh;
using oracles::GridCase;

namespace {

VerifyReport check(const GridCase& grid, double min_angle = 44.9, double max_area = 0.51) {
  VerifyOptions options;
  options.min_angle = min_angle;
  options.max_area = max_area;
  return verify(grid.mesh, grid.input, options);
}

std::string all_messages(const VerifyReport& report) {
  std::string text;
  for (std::size_t f = 0; f < kFlawCount; ++f)
    for (const auto& message : report.findings.messages(static_cast<Flaw>(f)))
      text += std::string(flaw_name(static_cast<Flaw>(f))) + ": " + message + "\n";
  return text;
}

#define CHECK_ONLY(report, flaw)                                   \
  do {                                                             \
    INFO(all_messages(report));                                    \
    CHECK(report.findings.count(flaw) > 0);                        \
    CHECK(report.findings.total() == report.findings.count(flaw)); \
    CHECK(!report.findings.messages(flaw).empty());                \
  } while (false)

#define CHECK_HAS(report, flaw)             \
  do {                                      \
    INFO(all_messages(report));             \
    CHECK(report.findings.count(flaw) > 0); \
  } while (false)

std::size_t find_triangle(const MeshPiece& mesh, std::array<std::int32_t, 3> corners) {
  std::sort(corners.begin(), corners.end());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto sorted = mesh.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    if (sorted == corners) return t;
  }
  FAIL("the mesh has no such triangle");
  return 0;
}

void drop_triangle(MeshPiece& mesh, std::size_t t) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.regions.erase(mesh.regions.begin() + static_cast<std::ptrdiff_t>(t));
}

void add_triangle(MeshPiece& mesh, std::array<std::int32_t, 3> corners, double region) {
  mesh.triangles.push_back(corners);
  mesh.regions.push_back(region);
}

std::int32_t add_point(MeshPiece& mesh, Point p) {
  mesh.points.push_back(p);
  mesh.point_markers.push_back(0);
  return static_cast<std::int32_t>(mesh.points.size()) - 1;
}

MeshPiece::Edge& subsegment(MeshPiece& mesh, std::int32_t a, std::int32_t b) {
  for (auto& edge : mesh.edges)
    if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a)) return edge;
  FAIL("the mesh has no such subsegment");
  return mesh.edges.front();
}

void drop_subsegment(MeshPiece& mesh, std::int32_t a, std::int32_t b) {
  mesh.edges.erase(mesh.edges.begin() + (&subsegment(mesh, a, b) - mesh.edges.data()));
}

}  // namespace

TEST_CASE("a right mesh is accepted, with and without its input") {
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
  CHECK_ONLY(check(grid), Flaw::bad_array);
  grid = GridCase();
  grid.mesh.point_markers.pop_back();
  CHECK_ONLY(check(grid), Flaw::bad_array);
  grid = GridCase();
  grid.mesh.attributes.push_back(1);
  CHECK_ONLY(check(grid), Flaw::bad_array);
}

TEST_CASE("indices that name no point, or one point twice") {
  GridCase grid;
  grid.mesh.triangles[7][1] = static_cast<std::int32_t>(grid.mesh.points.size());
  CHECK_ONLY(check(grid), Flaw::bad_index);
  grid = GridCase();
  grid.mesh.triangles[7][1] = -1;
  CHECK_ONLY(check(grid), Flaw::bad_index);
  grid = GridCase();
  grid.mesh.triangles[7][1] = grid.mesh.triangles[7][0];
  CHECK_ONLY(check(grid), Flaw::bad_index);
  grid = GridCase();
  grid.mesh.edges[3].b = -7;
  CHECK_ONLY(check(grid), Flaw::bad_index);
}

TEST_CASE("coordinates that cannot be computed with") {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e-300}) {
    GridCase grid;
    grid.mesh.points[5].x = bad;
    CHECK_ONLY(check(grid), Flaw::bad_coordinate);
  }
}

TEST_CASE("an inverted triangle") {
  GridCase grid;
  std::swap(grid.mesh.triangles[40][0], grid.mesh.triangles[40][1]);
  CHECK_HAS(check(grid), Flaw::not_counterclockwise);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::not_counterclockwise);
}

TEST_CASE("a vertex moved across an edge inverts a triangle; moved a little it breaks Delaunay") {
  GridCase grid;
  grid.mesh.points[static_cast<std::size_t>(grid.at(2, 2))] = {3.5, 2};
  CHECK_HAS(check(grid), Flaw::not_counterclockwise);
  grid = GridCase();
  grid.mesh.points[static_cast<std::size_t>(grid.at(2, 2))] = {2.25, 2.125};
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::not_delaunay);
}

TEST_CASE("a Steiner vertex moved by one unit in the last place breaks an exact cocircularity") {
  GridCase grid;
  grid.mesh.points[static_cast<std::size_t>(grid.at(2, 2))].x = std::nextafter(2.0, 3.0);
  CHECK_ONLY(check(grid, 0, 0), Flaw::not_delaunay);
}

TEST_CASE("an edge flipped against Delaunay") {
  MeshPiece mesh;
  mesh.points = {{0, 0}, {2, -1}, {4, 0}, {2, 1}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  CHECK(verify(mesh, {}).accepted());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  CHECK_ONLY(verify(mesh, {}), Flaw::not_delaunay);
  mesh.edges.push_back({0, 2, 1});  // a constrained edge need not be Delaunay
  CHECK(verify(mesh, {}).accepted());
}

TEST_CASE("a missing triangle") {
  GridCase grid;
  drop_triangle(grid.mesh, find_triangle(grid.mesh, {grid.at(10, 10), grid.at(11, 10), grid.at(11, 11)}));
  CHECK_HAS(check(grid), Flaw::open_edge);
  CHECK_HAS(check(grid), Flaw::wrong_area);
  CHECK_HAS(check(grid), Flaw::wrong_euler);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::open_edge);
}

TEST_CASE("a triangle listed twice") {
  GridCase grid;
  add_triangle(grid.mesh, grid.mesh.triangles[33], 10);
  CHECK_HAS(check(grid), Flaw::duplicate_triangle);
  GridCase turned;
  const auto [a, b, c] = turned.mesh.triangles[33];
  add_triangle(turned.mesh, {b, c, a}, 10);
  CHECK_HAS(check(turned), Flaw::duplicate_triangle);
}

TEST_CASE("a third triangle on an edge") {
  GridCase grid;
  const std::int32_t far = grid.at(10, 5);
  add_triangle(grid.mesh, {grid.at(0, 2), grid.at(1, 2), far}, 10);
  CHECK_HAS(check(grid), Flaw::edge_used_twice);
}

TEST_CASE("a subsegment that is missing, listed twice or no edge") {
  GridCase grid;
  drop_subsegment(grid.mesh, grid.at(3, 0), grid.at(4, 0));
  CHECK_HAS(check(grid), Flaw::open_edge);
  CHECK_HAS(check(grid), Flaw::segment_missing);
  grid = GridCase();  // inside the domain nothing but the input can tell
  drop_subsegment(grid.mesh, grid.at(3, 9), grid.at(4, 9));
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::segment_missing);
  grid = GridCase();
  grid.mesh.edges.push_back(grid.mesh.edges[4]);
  CHECK_HAS(check(grid), Flaw::duplicate_subsegment);
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::duplicate_subsegment);
  grid = GridCase();
  grid.mesh.edges.push_back({grid.at(1, 1), grid.at(9, 2), 1});
  CHECK_HAS(check(grid), Flaw::stray_subsegment);
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::stray_subsegment);
}

TEST_CASE("a subsegment that lies on no input segment") {
  GridCase grid;
  grid.mesh.edges.push_back({grid.at(1, 10), grid.at(1, 11), 0});
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_ONLY(check(grid), Flaw::unknown_subsegment);
}

TEST_CASE("all subsegments of an input segment missing") {
  GridCase grid;
  for (int x = 0; x < GridCase::kSize; ++x) drop_subsegment(grid.mesh, grid.at(x, 9), grid.at(x + 1, 9));
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::segment_missing);
}

TEST_CASE("a wrong marker") {
  GridCase grid;
  subsegment(grid.mesh, grid.at(7, 3), grid.at(6, 3)).marker = 4;
  CHECK_ONLY(check(grid), Flaw::wrong_marker);
  CHECK(check(grid).findings.messages(Flaw::wrong_marker).front().find("has marker 4, expected 5") !=
        std::string::npos);
}

TEST_CASE("a wrong region attribute") {
  GridCase grid;
  grid.mesh.regions[17] = 20;
  CHECK_ONLY(check(grid), Flaw::wrong_region);
  grid = GridCase();
  CHECK(check(grid).regions_listed);
  grid.mesh.regions.clear();
  CHECK(check(grid).accepted());
  CHECK(!check(grid).regions_listed);
}

TEST_CASE("a filled hole") {
  GridCase grid;
  const auto point = [&](int x, int y) { return (x > 4 && x < 8 && y > 3 && y < 7) ? -1 : grid.at(x, y); };
  std::array<std::array<std::int32_t, 5>, 5> in_hole{};
  for (int y = 3; y <= 7; ++y)
    for (int x = 4; x <= 8; ++x) {
      const std::int32_t known = point(x, y);
      in_hole[static_cast<std::size_t>(y - 3)][static_cast<std::size_t>(x - 4)] =
          known >= 0 ? known : add_point(grid.mesh, {static_cast<double>(x), static_cast<double>(y)});
    }
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 4; ++x) {
      const std::int32_t a = in_hole[y][x], b = in_hole[y][x + 1], c = in_hole[y + 1][x + 1], d = in_hole[y + 1][x];
      add_triangle(grid.mesh, {a, b, c}, 10);
      add_triangle(grid.mesh, {c, d, a}, 10);
    }
  CHECK(verify(grid.mesh, {}).accepted());
  const VerifyReport report = check(grid);
  CHECK_HAS(report, Flaw::hole_filled);
  CHECK_HAS(report, Flaw::wrong_area);
  CHECK_HAS(report, Flaw::wrong_euler);
}

TEST_CASE("a triangle outside the domain") {
  GridCase grid;
  const std::int32_t tip = add_point(grid.mesh, {5.5, 12.75});
  add_triangle(grid.mesh, {grid.at(5, 12), grid.at(6, 12), tip}, 20);
  grid.mesh.edges.push_back({grid.at(6, 12), tip, 3});
  grid.mesh.edges.push_back({tip, grid.at(5, 12), 3});
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::unknown_subsegment);
  CHECK_HAS(check(grid), Flaw::wrong_area);

  MeshPiece two;
  two.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  two.triangles = {{0, 1, 2}, {1, 3, 2}};
  two.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {1, 3, 0}, {3, 2, 0}};
  Pslg one;
  one.points = two.points;
  one.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  CHECK_HAS(verify(two, one, {}), Flaw::outside_filled);
}

TEST_CASE("an input point that is not a vertex") {
  GridCase grid;
  grid.input.points.push_back({1.5, 6.5});
  CHECK_HAS(check(grid), Flaw::point_missing);
  grid = GridCase();  // in the hole and outside, points are carved
  grid.input.points.push_back({4.5, 6.5});
  grid.input.points.push_back({40, 6});
  CHECK(check(grid).accepted());
}

TEST_CASE("a point that is used by no triangle is counted and is no flaw") {
  GridCase grid;
  add_point(grid.mesh, {1.5, 1.25});
  CHECK(check(grid).accepted());
  CHECK(check(grid).unused_points == 1);
}

TEST_CASE("a vertex in an edge: a T-junction") {
  GridCase grid;
  // Cut the triangle on one side of the edge (2,2)-(3,2), but not the one on the other.
  const std::int32_t a = grid.at(2, 2), b = grid.at(3, 2), c = grid.at(3, 3);
  const std::int32_t m = add_point(grid.mesh, {2.5, 2});
  grid.mesh.triangles[find_triangle(grid.mesh, {a, b, c})] = {a, m, c};
  add_triangle(grid.mesh, {m, b, c}, 10);
  CHECK_HAS(check(grid), Flaw::open_edge);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::open_edge);
  // Called a slit of constrained edges, it is still seen: the boundary touches itself.
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{a, m, 0}, {m, b, 0}, {a, b, 0}});
  CHECK_HAS(verify(grid.mesh, {}), Flaw::boundary_crosses);
}

TEST_CASE("a crack between two copies of a point") {
  GridCase grid;
  const std::int32_t old = grid.at(0, 5), copy = add_point(grid.mesh, {0, 5});
  const std::int32_t above = grid.at(0, 6);
  for (auto& triangle : grid.mesh.triangles)
    if (std::find(triangle.begin(), triangle.end(), above) != triangle.end())
      std::replace(triangle.begin(), triangle.end(), old, copy);
  CHECK_HAS(check(grid), Flaw::duplicate_point);
  CHECK_HAS(verify(grid.mesh, {}), Flaw::duplicate_point);
}

TEST_CASE("two sheets over the same place") {
  GridCase grid;
  // A second copy of the whole mesh, shifted by half a cell: each sheet is a triangulation of its own.
  const MeshPiece sheet = grid.mesh;
  const auto shift = static_cast<std::int32_t>(sheet.points.size());
  for (const Point& p : sheet.points) add_point(grid.mesh, {p.x + 0.5, p.y + 0.25});
  for (const auto& [a, b, c] : sheet.triangles) add_triangle(grid.mesh, {a + shift, b + shift, c + shift}, 10);
  for (const auto& [a, b, marker] : sheet.edges) grid.mesh.edges.push_back({a + shift, b + shift, marker});
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::boundary_crosses);
}

TEST_CASE("a sheet inside another one, no edges crossing") {
  GridCase grid;
  const std::int32_t a = add_point(grid.mesh, {1.25, 1.125}), b = add_point(grid.mesh, {1.75, 1.125}),
                     c = add_point(grid.mesh, {1.5, 1.25});
  add_triangle(grid.mesh, {a, b, c}, 10);
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{a, b, 1}, {b, c, 1}, {c, a, 1}});
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::overlap);
}

TEST_CASE("triangles that wind twice around a vertex") {
  MeshPiece mesh;
  mesh.points.push_back({0, 0});
  for (int i = 0; i < 10; ++i) {
    const double angle = i * 0.4 * 3.14159265358979, radius = i < 5 ? 1 : 1.25;
    mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    mesh.triangles.push_back({0, i + 1, (i + 1) % 10 + 1});
    mesh.edges.push_back({i + 1, (i + 1) % 10 + 1, 1});
  }
  const VerifyReport report = verify(mesh, {});
  INFO(all_messages(report));
  CHECK((report.findings.count(Flaw::boundary_crosses) > 0 || report.findings.count(Flaw::overlap) > 0));
}

TEST_CASE("a closed ring and a further fan at one vertex") {
  GridCase grid;
  const std::int32_t hub = grid.at(2, 2);
  const std::int32_t p = add_point(grid.mesh, {2.25, 2.0625}), q = add_point(grid.mesh, {2.25, 2.125});
  add_triangle(grid.mesh, {hub, p, q}, 10);
  grid.mesh.edges.insert(grid.mesh.edges.end(), {{hub, p, 1}, {p, q, 1}, {q, hub, 1}});
  CHECK_HAS(check(grid), Flaw::tangled_vertex);
}

TEST_CASE("a chain that leaves its segment") {
  GridCase grid;
  grid.mesh.points[static_cast<std::size_t>(grid.at(6, 9))].y = 9.0000001;
  CHECK_HAS(check(grid, 0, 0), Flaw::off_segment);
  CHECK(check(grid, 0, 0).findings.messages(Flaw::off_segment).front().find("off its line") != std::string::npos);
  grid = GridCase();  // rounding is no flaw
  grid.mesh.points[static_cast<std::size_t>(grid.at(6, 9))].y = std::nextafter(9.0, 10.0);
  CHECK(check(grid, 0, 0).findings.count(Flaw::off_segment) == 0);
}

TEST_CASE("bounds") {
  const GridCase grid;
  CHECK_ONLY(check(grid, 45.1), Flaw::small_angle);
  CHECK(check(grid, 45.1).findings.count(Flaw::small_angle) == grid.mesh.triangles.size());
  CHECK(check(grid, 45.1).findings.messages(Flaw::small_angle).size() == 5);
  CHECK_ONLY(check(grid, 0, 0.499), Flaw::large_area);
  CHECK(check(grid, 45, 0.5).accepted());
}

TEST_CASE("the area bound of a region") {
  GridCase grid;
  grid.input.regions[1].max_area = 0.4;
  const VerifyReport report = check(grid, 0, 0);
  CHECK_ONLY(report, Flaw::large_area);
  CHECK(report.findings.count(Flaw::large_area) == 72);
  VerifyOptions options;
  options.region_areas = false;
  CHECK(verify(grid.mesh, grid.input, options).accepted());
}

TEST_CASE("an input that is not planar") {
  GridCase grid;
  grid.input.segments.push_back({0, 3, 7});
  CHECK_ONLY(check(grid), Flaw::input_not_planar);
  grid = GridCase();
  grid.input.points.push_back({6, 0});
  CHECK_ONLY(check(grid), Flaw::input_not_planar);
}

TEST_CASE("another input") {
  GridCase grid;
  grid.input.segments.pop_back();
  CHECK_HAS(check(grid), Flaw::unknown_subsegment);
  grid = GridCase();
  grid.input.holes.clear();
  CHECK_HAS(check(grid), Flaw::not_covered);
}

TEST_CASE("a mesh whose file lists no subsegments") {
  GridCase grid;
  grid.mesh.edges.clear();
  const VerifyReport report = verify(grid.mesh, {});
  CHECK(report.accepted());
  CHECK(!report.subsegments_listed);
  CHECK_HAS(check(grid), Flaw::segment_missing);
}

TEST_CASE("an empty mesh") {
  CHECK(verify(MeshPiece{}, {}).accepted());
  const VerifyReport report = verify(MeshPiece{}, GridCase().input, {});
  CHECK_HAS(report, Flaw::segment_missing);
  CHECK_HAS(report, Flaw::point_missing);
  CHECK_HAS(report, Flaw::wrong_area);
}
