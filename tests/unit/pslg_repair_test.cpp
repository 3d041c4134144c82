#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/predicates.hpp"
#include "pslg/open_boundary.hpp"
#include "pslg/poly_file.hpp"
#include "support/error_text.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Segments = std::vector<Pslg::Segment>;

Pslg square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return pslg;
}

std::string error_of(Pslg pslg) {
  return error_text<InputError>([&] { (void)repair(pslg, "in.poly"); });
}

}  // namespace

TEST_CASE("a planar graph is left as it is") {
  Pslg pslg = square();
  const RepairReport report = repair(pslg);
  CHECK_FALSE(report.changed());
  CHECK(report.summary().empty());
  CHECK(pslg.points == square().points);
  CHECK(pslg.segments == square().segments);
  CHECK(report.original_point == std::vector<std::int32_t>{0, 1, 2, 3});
}

TEST_CASE("duplicate points are merged; the first one keeps its attributes and takes over a missing marker") {
  Pslg pslg = square();
  pslg.points.insert(pslg.points.begin() + 1, {0, 0});
  pslg.segments = {{1, 2, 1}, {2, 3, 2}, {3, 4, 3}, {4, 0, 4}};
  pslg.point_markers = {0, 7, 1, 1, 1};
  pslg.attributes_per_point = 1;
  pslg.attributes = {10, 20, 30, 40, 50};
  const RepairReport report = repair(pslg);
  CHECK(pslg.points == square().points);
  CHECK(pslg.segments == square().segments);
  CHECK(pslg.point_markers == std::vector<std::int32_t>{7, 1, 1, 1});
  CHECK(pslg.attributes == std::vector<double>{10, 30, 40, 50});
  CHECK(report.original_point == std::vector<std::int32_t>{0, 2, 3, 4});
  CHECK(report.summary() ==
        "repaired: duplicate vertices merged: 1\n"
        "  vertex 2 (0, 0) merged into vertex 1 (0, 0)\n");
}

TEST_CASE("points within rounding error of each other are one; farther ones are two") {
  Pslg pslg = square();
  pslg.points.push_back({4, std::nextafter(4, 5)});
  CHECK(repair(pslg).close_points.count == 1);
  CHECK(pslg.points == square().points);
  pslg.points.push_back({4, 4 + 1e-13});
  CHECK_FALSE(repair(pslg).changed());
}

TEST_CASE("segments of length zero and duplicates are dropped, conflicting markers reported") {
  Pslg pslg = square();
  pslg.segments.push_back({2, 2, 9});
  pslg.segments.push_back({1, 0, 0});
  pslg.segments.push_back({1, 0, 8});
  const RepairReport report = repair(pslg);
  CHECK(pslg.segments == square().segments);
  CHECK(report.zero_length_segments.count == 1);
  CHECK(report.duplicate_segments.count == 2);
  CHECK(report.marker_conflicts.count == 1);
  CHECK(report.summary().find("segment 5 begins and ends at vertex 3 (4, 4)") != std::string::npos);
}

TEST_CASE("a marker survives merging with a segment that has none") {
  Pslg pslg = square();
  pslg.segments[0].marker = 0;
  pslg.segments.push_back({1, 0, 5});
  CHECK(repair(pslg).marker_conflicts.count == 0);
  CHECK(pslg.segments[0] == Pslg::Segment{0, 1, 5});
}

TEST_CASE("a segment is split at points on it, in order, and keeps its marker") {
  Pslg pslg = square();
  pslg.points.push_back({3, 0});
  pslg.points.push_back({1, 0});
  const RepairReport report = repair(pslg);
  CHECK(report.points_on_segments.count == 2);
  CHECK(pslg.segments == Segments{{0, 5, 1}, {5, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}});
}

TEST_CASE("a segment that misses a point by rounding is bent to pass through it") {
  Pslg pslg;
  const double third = 1.0 / 3;
  pslg.points = {{0, 0}, {1, 0.7}, {third, third * 0.7}, {0, 1}};
  pslg.segments = {{0, 1, 0}, {2, 3, 0}};
  pslg.points[2].y = std::nextafter(pslg.points[2].y, 1);
  const RepairReport report = repair(pslg);
  CHECK(report.points_close_segments.count == 1);
  CHECK(pslg.segments == Segments{{0, 2, 0}, {2, 1, 0}, {2, 3, 0}});
}

TEST_CASE("points without segments get their hull, which does not count as a change") {
  Pslg pslg = square();
  pslg.segments.clear();
  pslg.points.push_back({2, 0});
  pslg.points.push_back({1, 1});
  const RepairReport report = repair(pslg);
  CHECK(pslg.segments == Segments{{0, 4, 1}, {4, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}});
  CHECK_FALSE(report.changed());
  CHECK(report.summary().empty());
}

TEST_CASE("the hull is bent to pass through points within rounding error of it, and that is reported") {
  Pslg pslg;
  pslg.points = {{0, 0}, {1.5, 0}, {1.5, 1.1}, {0.5, 1.3}, {0, 1.4000000000000001}};
  const RepairReport report = repair(pslg);
  CHECK(pslg.segments == Segments{{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 0, 1}});
  CHECK(report.points_close_segments.count == 1);
  CHECK(report.summary().find("vertex 4 (0.5, 1.3) on an edge of the hull") != std::string::npos);
  CHECK_FALSE(repair(pslg).changed());
}

TEST_CASE("overlapping collinear segments become pieces that do not overlap") {
  Pslg pslg = square();
  pslg.points.push_back({1, 0});
  pslg.points.push_back({6, 0});
  pslg.segments.push_back({4, 5, 6});
  const RepairReport report = repair(pslg);
  CHECK(report.overlaps.count == 1);
  CHECK(report.marker_conflicts.count == 1);
  CHECK(pslg.segments == Segments{{0, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}, {1, 5, 6}});
}

TEST_CASE("crossing segments meet in a new vertex with interpolated attributes") {
  Pslg pslg = square();
  pslg.segments = {{0, 2, 5}, {1, 3, 6}};
  pslg.attributes_per_point = 2;
  pslg.attributes = {0, 1, 0, 0, 4, 3, 0, 0};
  pslg.point_markers = {1, 1, 1, 1};
  const RepairReport report = repair(pslg);
  CHECK(report.crossings.count == 1);
  CHECK(report.crossings.examples == std::vector<std::string>{"segment 1 and segment 2 cross at (2, 2)"});
  REQUIRE(pslg.points.size() == 5);
  CHECK(pslg.points[4] == Point{2, 2});
  CHECK(pslg.segments == Segments{{0, 4, 5}, {4, 2, 5}, {1, 4, 6}, {4, 3, 6}});
  CHECK(pslg.attributes[8] == 2);
  CHECK(pslg.attributes[9] == 2);
  CHECK(pslg.point_markers.size() == 5);
  CHECK(report.original_point.back() == -1);
}

TEST_CASE("numbers in messages are those of the file") {
  Pslg pslg = square();
  pslg.first_number = 0;
  pslg.points.push_back({0, 0});
  CHECK(repair(pslg).summary().find("vertex 4 (0, 0) merged into vertex 0 (0, 0)") != std::string::npos);
}

TEST_CASE("only seeds that are certainly outside are reported") {
  Pslg pslg = square();
  pslg.points.insert(pslg.points.end(), {{10, 10}, {12, 10}, {10, 12}});
  pslg.segments.insert(pslg.segments.end(), {{4, 5, 0}, {5, 6, 0}, {6, 4, 0}});
  pslg.holes = {{2, 2}, {8, 8}, {100, 0}};
  pslg.regions = {{{10.5, 10.5}, 1, 0}, {{11.5, 11.5}, 2, 0}};
  const RepairReport report = repair(pslg);
  CHECK(report.warnings ==
        std::vector<std::string>{"hole 2 at (8, 8) lies outside the domain; it removes nothing",
                                 "hole 3 at (100, 0) lies outside the domain; it removes nothing",
                                 "region 2 at (11.5, 11.5) lies outside the domain; it has no effect"});
  CHECK_FALSE(report.changed());
}

TEST_CASE("input without a clear intent is an error") {
  Pslg pslg = square();
  pslg.holes = {{2, 0}};
  CHECK(error_of(pslg) == "in.poly: hole 1 at (2, 0) lies on a segment; move it to the intended side");
  pslg = square();
  pslg.points[3].x = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_of(pslg) == "in.poly: vertex 4 (nan, 4) is outside the range of coordinates; scale the input");
  pslg = square();
  pslg.segments[1].b = 4;
  CHECK(error_of(pslg) ==
        "in.poly: segment 2 names a vertex that does not exist; vertices are numbered as the points are");
  pslg = square();
  pslg.point_markers = {1};
  CHECK(error_of(pslg) == "in.poly: there are 1 markers for 4 points; give none or one for each");
  pslg = {};
  pslg.points = {{0, 0}, {1, 1}, {0, 0}};
  CHECK(error_of(pslg) == "in.poly: has 2 different vertices; a mesh needs at least three");
  pslg.points = {{0, 0}, {1, 1}, {3, 3}, {2, 2}};
  CHECK(error_of(pslg) == "in.poly: all vertices lie on one line; a mesh needs an area");
}

TEST_CASE("a distance that joins the whole domain is named as what is wrong") {
  const auto snapped = [](Pslg pslg, double snap) {
    return error_text<InputError>([&] { (void)repair(pslg, "in.poly", {.snap = snap}); });
  };
  for (const double snap : {100.0, 4.0})
    CHECK(snapped(square(), snap) == "in.poly: has no area left when all that is at most " +
                                         std::to_string(static_cast<int>(snap)) +
                                         " apart is joined; snap by a smaller distance: the domain is 4 by 4");
  CHECK(snapped(square(), 0.5) == "no error");
  Pslg line;
  line.points = {{0, 0}, {1, 1}, {3, 3}};
  CHECK(snapped(line, 100) == "in.poly: has 1 different vertices; a mesh needs at least three");
}

TEST_CASE("the published models need no repair") {
  for (const char* name : {"A", "key", "pipe", "cylinder_flow", "chesapeake"}) {
    CAPTURE(std::string(name));
    const std::string path = std::string(DRIFTMESH_SOURCE_DIR "/../shared/data/") + name + ".poly";
    if (!std::filesystem::exists(path)) {
      MESSAGE("skipped, not here: " << path);
      continue;
    }
    Pslg pslg = read_poly(path);
    const RepairReport report = repair(pslg, path);
    CHECK(report.summary() == "");
    const OpenBoundary boundary = find_open_boundary(pslg);
    CHECK(boundary.has_loop);
    CHECK(boundary.open_ends.empty());
  }
}

TEST_CASE("an open boundary is located and described") {
  Pslg pslg = square();
  pslg.segments.pop_back();
  repair(pslg);
  const OpenBoundary boundary = find_open_boundary(pslg);
  CHECK_FALSE(boundary.has_loop);
  CHECK(boundary.open_ends == std::vector<std::int32_t>{0, 3});
  CHECK(describe_open_boundary(pslg) ==
        "the segments enclose no area: the outer boundary is open, and its ends (0, 0) and (0, 4) are 4 apart; close "
        "the gap, or have the input snapped by more than that");
  pslg.segments.erase(pslg.segments.begin() + 1);  // a chain of one segment is not to be closed upon itself
  CHECK(describe_open_boundary(pslg).find("the nearest of its 4 free ends, (0, 0) and (0, 4), are 4 apart") !=
        std::string::npos);
  pslg.segments.resize(1);
  CHECK(describe_open_boundary(pslg).ends_with("open or missing (1 segments); close the boundary"));
}

TEST_CASE("the narrowest gap is the nearest pair of free ends that no segment joins") {
  Pslg pslg;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0, 1);
  for (std::int32_t i = 0; i < 60; ++i) {
    pslg.points.push_back({coordinate(random), coordinate(random)});
    if (i % 2 == 1) pslg.segments.push_back({i - 1, i, 0});
  }
  const std::vector<std::int32_t> ends = find_open_boundary(pslg).open_ends;
  REQUIRE(ends.size() == 60);
  double least = 2;
  for (const std::int32_t a : ends)
    for (const std::int32_t b : ends)
      if (a / 2 != b / 2)
        least = std::min(
            least, std::hypot(pslg.points[static_cast<std::size_t>(a)].x - pslg.points[static_cast<std::size_t>(b)].x,
                              pslg.points[static_cast<std::size_t>(a)].y - pslg.points[static_cast<std::size_t>(b)].y));
  const auto gap = find_gap(pslg, ends);
  REQUIRE(gap);
  CHECK(gap->width == least);
}

TEST_CASE("input that would take forever fails early") {
  Pslg pslg;
  const std::int32_t n = 7000;  // nested segments on one line: n^2 / 2 points on segments
  for (std::int32_t i = 0; i < n; ++i) {
    pslg.points.push_back({static_cast<double>(i), 0});
    pslg.points.push_back({static_cast<double>(2 * n - i), 0});
    pslg.segments.push_back({2 * i, 2 * i + 1, 0});
  }
  CHECK(error_of(pslg) ==
        "in.poly: the segments cross or overlap more than 20000000 times; their vertex numbers are probably wrong");
}

TEST_CASE("coordinates that are too small for exact midpoints are rounded, and reported") {
  Pslg pslg;
  pslg.points = {{0, 0}, {1e-36, 3e-60}, {1e-36, 1e-36}, {1.2 * kInputGrid, 1e-36}};
  for (std::int32_t i = 0; i < 4; ++i) pslg.segments.push_back({i, (i + 1) % 4, 1});
  pslg.holes = {{1e-37, 3e-37}};
  const RepairReport report = repair(pslg);
  CHECK(report.rounded_points.count == 2);
  CHECK(pslg.points[1].y == 0);
  CHECK(pslg.points[3].x == kInputGrid);
  CHECK(report.summary().find("rounded") != std::string::npos);
  CHECK_FALSE(repair(pslg).changed());
}

TEST_CASE("where snapping closes a spike of a polygon, its ring turns before it") {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 2}, {5, 2}, {7, 2}, {5, 2.001}, {4, 2.001}, {4, 4}, {0, 4}};
  Pslg::Ring ring;
  for (std::int32_t i = 0; i < 9; ++i) {
    pslg.segments.push_back({i, (i + 1) % 9, 1});
    ring.push_back(i);
  }
  pslg.polygons = {{.rings = {ring}, .region = -1}};
  const RepairReport report = repair(pslg, "input", {.snap = 0.01});
  CHECK(report.collapsed.count == 2);  // pieces: to the spike's tip, and to where it is bent
  REQUIRE(pslg.polygons.size() == 1);
  std::vector<Point> corners;
  for (const std::int32_t v : pslg.polygons[0].rings[0]) corners.push_back(pslg.points[static_cast<std::size_t>(v)]);
  CHECK(corners == std::vector<Point>{{0, 0}, {4, 0}, {4, 2}, {4, 4}, {0, 4}});
}
