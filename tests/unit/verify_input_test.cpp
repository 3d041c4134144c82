#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "damaged_grid.hpp"

// Checks of a mesh against its input: segments, markers, regions, holes, points and bounds. Each test damages one of
// the two, and expects the corresponding kind of flaw.

using namespace driftmesh;
using namespace driftmesh::testing;
using oracles::GridCase;

TEST_CASE("a subsegment that is missing, listed twice or no edge") {
  GridCase grid;
  drop_subsegment(grid.mesh, grid.at(3, 0), grid.at(4, 0));
  CHECK_HAS(check(grid), Flaw::kOpenEdge);
  CHECK_HAS(check(grid), Flaw::kSegmentMissing);
  grid = GridCase();  // inside the domain, only the input shows it
  drop_subsegment(grid.mesh, grid.at(3, 9), grid.at(4, 9));
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::kSegmentMissing);
  grid = GridCase();
  grid.mesh.edges.push_back(grid.mesh.edges[4]);
  CHECK_HAS(check(grid), Flaw::kDuplicateSubsegment);
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::kDuplicateSubsegment);
  grid = GridCase();
  grid.mesh.edges.push_back({grid.at(1, 1), grid.at(9, 2), 1});
  CHECK_HAS(check(grid), Flaw::kStraySubsegment);
  CHECK_ONLY(verify(grid.mesh, {}), Flaw::kStraySubsegment);
}

TEST_CASE("a subsegment that lies on no input segment") {
  GridCase grid;
  grid.mesh.edges.push_back({grid.at(1, 10), grid.at(1, 11), 0});
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_ONLY(check(grid), Flaw::kUnknownSubsegment);
}

TEST_CASE("all subsegments of an input segment missing") {
  GridCase grid;
  for (int x = 0; x < GridCase::kSize; ++x) drop_subsegment(grid.mesh, grid.at(x, 9), grid.at(x + 1, 9));
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::kSegmentMissing);
}

TEST_CASE("a wrong marker") {
  GridCase grid;
  subsegment(grid.mesh, grid.at(7, 3), grid.at(6, 3)).marker = 4;
  CHECK_ONLY(check(grid), Flaw::kWrongMarker);
  CHECK(check(grid).findings.messages(Flaw::kWrongMarker).front().find("has marker 4, expected 5") !=
        std::string::npos);
}

TEST_CASE("a wrong region attribute") {
  GridCase grid;
  grid.mesh.regions[17] = 20;
  CHECK_ONLY(check(grid), Flaw::kWrongRegion);
  grid = GridCase();
  CHECK(check(grid).regions_listed);
  grid.mesh.regions.clear();
  CHECK(check(grid).accepted());
  CHECK(!check(grid).regions_listed);
}

TEST_CASE("a wrong marker or attribute of a point") {
  GridCase grid;
  grid.input.point_markers.assign(grid.input.points.size(), 7);
  grid.input.attributes_per_point = 2;
  for (const Point& p : grid.input.points) grid.input.attributes.insert(grid.input.attributes.end(), {p.x, p.y + 0.5});
  grid.mesh.point_markers.assign(grid.mesh.points.size(), 7);
  grid.mesh.attributes_per_point = 2;
  for (const Point& p : grid.mesh.points) grid.mesh.attributes.insert(grid.mesh.attributes.end(), {p.x, p.y + 0.5});
  CHECK(check(grid).accepted());
  const GridCase right = grid;
  const std::size_t corner = to_index(grid.at(0, 0));
  grid.mesh.point_markers[corner] = 8;
  CHECK_ONLY(check(grid), Flaw::kWrongPointMarker);
  CHECK(check(grid).findings.messages(Flaw::kWrongPointMarker).front().find("has marker 8, expected 7") !=
        std::string::npos);
  grid = right;
  grid.mesh.attributes[2 * corner + 1] = std::nextafter(0.5, 1);
  CHECK_ONLY(check(grid), Flaw::kWrongAttribute);
  grid = right;
  grid.mesh.attributes_per_point = 1;
  grid.mesh.attributes.resize(grid.mesh.points.size());
  CHECK_ONLY(check(grid), Flaw::kWrongAttribute);
  grid = right;  // a mesh that lists neither
  grid.mesh.point_markers.clear();
  grid.mesh.attributes.clear();
  grid.mesh.attributes_per_point = 0;
  CHECK(check(grid).accepted());
}

TEST_CASE("a mesh with another number of attributes than its input, though each of them has the same value") {
  GridCase grid;
  grid.input.attributes_per_point = 2;
  grid.input.attributes.assign(2 * grid.input.points.size(), 0.5);
  for (const int width : {1, 2, 3}) {
    CAPTURE(width);
    grid.mesh.attributes_per_point = width;
    grid.mesh.attributes.assign(width * grid.mesh.points.size(), 0.5);
    const VerifyReport report = check(grid);
    CHECK(report.accepted() == (width == 2));
    if (width == 2) continue;
    CHECK_ONLY(report, Flaw::kWrongAttribute);
    CHECK(report.findings.count(Flaw::kWrongAttribute) == 1);
    CHECK(report.findings.messages(Flaw::kWrongAttribute)[0] ==
          "points have " + std::to_string(width) + " attributes, expected 2");
  }
}

TEST_CASE("a point without a marker may have that of a subsegment there, or 1") {
  GridCase grid;
  grid.input.point_markers.assign(grid.input.points.size(), 0);
  grid.mesh.point_markers.assign(grid.mesh.points.size(), 0);
  const std::size_t corner = to_index(grid.at(0, 0));
  for (const Mesh::Edge& edge : grid.mesh.edges)
    if (to_index(edge.a) == corner || to_index(edge.b) == corner) {
      grid.mesh.point_markers[corner] = edge.marker;
      CHECK(check(grid).accepted());
    }
  grid.mesh.point_markers[corner] = 1;
  CHECK(check(grid).accepted());
  grid.mesh.point_markers[corner] = 77;
  CHECK_ONLY(check(grid), Flaw::kWrongPointMarker);
}

TEST_CASE("a filled hole") {
  GridCase grid;
  const auto point = [&](int x, int y) { return (x > 4 && x < 8 && y > 3 && y < 7) ? -1 : grid.at(x, y); };
  std::array<std::array<std::int32_t, 5>, 5> in_hole{};
  for (int y = 3; y <= 7; ++y)
    for (int x = 4; x <= 8; ++x) {
      const std::int32_t known = point(x, y);
      in_hole[y - 3][x - 4] =
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
  CHECK_HAS(report, Flaw::kHoleFilled);
  CHECK_HAS(report, Flaw::kWrongArea);
  CHECK_HAS(report, Flaw::kWrongEuler);
}

TEST_CASE("a triangle outside the domain") {
  GridCase grid;
  const std::int32_t tip = add_point(grid.mesh, {5.5, 12.75});
  add_triangle(grid.mesh, {grid.at(5, 12), grid.at(6, 12), tip}, 20);
  grid.mesh.edges.push_back({grid.at(6, 12), tip, 3});
  grid.mesh.edges.push_back({tip, grid.at(5, 12), 3});
  CHECK(verify(grid.mesh, {}).accepted());
  CHECK_HAS(check(grid), Flaw::kUnknownSubsegment);
  CHECK_HAS(check(grid), Flaw::kWrongArea);

  Mesh two;
  two.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  two.triangles = {{0, 1, 2}, {1, 3, 2}};
  two.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {1, 3, 0}, {3, 2, 0}};
  Pslg one;
  one.points = two.points;
  one.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  CHECK_HAS(verify(two, one, {}), Flaw::kOutsideFilled);
}

TEST_CASE("a chain along a segment that the input has outside the domain") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {1, 3, 0}, {3, 2, 0}};
  Pslg input;
  input.points = mesh.points;
  input.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {1, 3, 0}};  // the last has nothing on either side
  const VerifyReport report = verify(mesh, input, {});
  REQUIRE(report.findings.count(Flaw::kUnknownSubsegment) == 2);
  const auto& messages = report.findings.messages(Flaw::kUnknownSubsegment);
  CHECK(messages[0].ends_with("from point 1 at (1, 0) to point 3 at (1, 1) is an input segment outside the domain"));
  CHECK(messages[1].ends_with("from point 2 at (0, 1) to point 3 at (1, 1) joins points that no input segment joins"));
}

TEST_CASE("a second chain between the ends of a segment") {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, 0}, {1, 2}, {1, 0.5}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}, {0, 3, 0}, {3, 1, 0}};
  Pslg input;
  input.points = {{0, 0}, {2, 0}, {1, 2}};
  input.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  CHECK(verify(mesh, {}).accepted());
  const VerifyReport report = verify(mesh, input, {});
  CHECK_ONLY(report, Flaw::kUnknownSubsegment);
  CHECK(report.findings.messages(Flaw::kUnknownSubsegment)[0] ==
        "the chain of 2 subsegments from point 0 at (0, 0) to point 1 at (2, 0) doubles another one");
}

TEST_CASE("an input point that is not a vertex") {
  GridCase grid;
  grid.input.points.push_back({1.5, 6.5});
  CHECK_HAS(check(grid), Flaw::kPointMissing);
  grid = GridCase();  // in the hole and outside, points are carved
  grid.input.points.push_back({4.5, 6.5});
  grid.input.points.push_back({40, 6});
  CHECK(check(grid).accepted());
}

TEST_CASE("a chain that leaves its segment") {
  GridCase grid;
  grid.mesh.points[grid.at(6, 9)].y = 9.0000001;
  CHECK_HAS(check(grid, 0, 0), Flaw::kOffSegment);
  CHECK(check(grid, 0, 0).findings.messages(Flaw::kOffSegment).front().find("off its line") != std::string::npos);
  grid = GridCase();  // rounding is not a flaw
  grid.mesh.points[grid.at(6, 9)].y = std::nextafter(9.0, 10.0);
  CHECK(check(grid, 0, 0).findings.count(Flaw::kOffSegment) == 0);
}

TEST_CASE("points on a segment out of order, or beyond its ends") {
  const auto off_segment = [](const GridCase& grid) {
    const VerifyReport report = check(grid, 0, 0);
    INFO(all_messages(report));
    REQUIRE(report.findings.count(Flaw::kOffSegment) == 1);
    CHECK(report.findings.messages(Flaw::kOffSegment)[0].find(" is 0 off its line") != std::string::npos);
    return report.findings.messages(Flaw::kOffSegment)[0];
  };
  GridCase grid;
  std::swap(grid.mesh.points[grid.at(6, 9)], grid.mesh.points[grid.at(7, 9)]);
  CHECK(off_segment(grid).ends_with(" and 6 of 12 along it, after 7"));
  grid = GridCase();
  grid.mesh.points[grid.at(1, 9)].x = -1;
  CHECK(off_segment(grid).ends_with(" and -1 of 12 along it, after 0"));
  grid = GridCase();
  grid.mesh.points[grid.at(11, 9)].x = 13;
  CHECK(off_segment(grid).ends_with(" and 13 of 12 along it, after 10"));
}

TEST_CASE("bounds") {
  const GridCase grid;
  CHECK_ONLY(check(grid, 45.1), Flaw::kSmallAngle);
  CHECK(check(grid, 45.1).findings.count(Flaw::kSmallAngle) == grid.mesh.triangles.size());
  CHECK(check(grid, 45.1).findings.messages(Flaw::kSmallAngle).size() == 5);
  CHECK_ONLY(check(grid, 0, 0.499), Flaw::kLargeArea);
  CHECK(check(grid, 45, 0.5).accepted());
}

TEST_CASE("the area bound of a region") {
  GridCase grid;
  grid.input.regions[1].max_area = 0.4;
  const VerifyReport report = check(grid, 0, 0);
  CHECK_ONLY(report, Flaw::kLargeArea);
  CHECK(report.findings.count(Flaw::kLargeArea) == 72);
  VerifyOptions options;
  options.plain.region_areas = false;
  CHECK(verify(grid.mesh, grid.input, options).accepted());
}

TEST_CASE("points and segments that the input lists twice count once") {
  GridCase grid;
  const auto count = static_cast<std::int32_t>(grid.input.points.size());
  for (const Pslg::Segment& s : GridCase().input.segments) {
    grid.input.segments.push_back({s.b, s.a, s.marker + 10});  // the first marker is that of the segment
    grid.input.segments.push_back({s.a + count, s.b + count, s.marker});
  }
  for (const Point& p : GridCase().input.points) grid.input.points.push_back(p);
  const VerifyReport report = check(grid);
  INFO(all_messages(report));
  CHECK(report.accepted());
  CHECK(report.input_area == 128);
}

TEST_CASE("an input that is not planar") {
  GridCase grid;
  grid.input.segments.push_back({0, 3, 7});
  CHECK_ONLY(check(grid), Flaw::kInputNotPlanar);
  grid = GridCase();
  grid.input.points.push_back({6, 0});
  CHECK_ONLY(check(grid), Flaw::kInputNotPlanar);
}

TEST_CASE("another input") {
  GridCase grid;
  grid.input.segments.pop_back();
  CHECK_HAS(check(grid), Flaw::kUnknownSubsegment);
  grid = GridCase();
  grid.input.holes.clear();
  CHECK_HAS(check(grid), Flaw::kNotCovered);
}

TEST_CASE("a mesh whose file lists no subsegments") {
  GridCase grid;
  grid.mesh.edges.clear();
  const VerifyReport report = verify(grid.mesh, {});
  CHECK(report.accepted());
  CHECK(!report.subsegments_listed);
  CHECK_HAS(check(grid), Flaw::kSegmentMissing);
}

TEST_CASE("an empty mesh") {
  CHECK(verify(Mesh{}, {}).accepted());
  const VerifyReport report = verify(Mesh{}, GridCase().input, {});
  CHECK_HAS(report, Flaw::kSegmentMissing);
  CHECK_HAS(report, Flaw::kPointMissing);
  CHECK_HAS(report, Flaw::kWrongArea);
}
