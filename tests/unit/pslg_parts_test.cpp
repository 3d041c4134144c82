#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/predicates.hpp"
#include "pslg/closeness.hpp"
#include "pslg/contour.hpp"
#include "pslg/enclosing_ring.hpp"
#include "pslg/names.hpp"
#include "pslg/open_boundary.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/polygons.hpp"
#include "pslg/polylines.hpp"
#include "support/error_text.hpp"
#include "support/rings.hpp"
#include "temporary_folder.hpp"

// Parts of what repairs and reads domains, each by itself.

using namespace driftmesh;
using driftmesh::testing::add_ring;
using driftmesh::testing::error_text;

namespace {

/// The points of each line in order, each from the lesser end, a closed one from its least point to the lesser
/// neighbor.
std::vector<std::vector<std::int32_t>> lines_of(const Pslg& pslg) {
  std::vector<std::vector<std::int32_t>> all;
  for (Polyline line : polylines_of(pslg)) {
    REQUIRE(line.segments.size() == line.points.size() - (line.closed ? 0 : 1));
    for (std::size_t i = 0; i < line.segments.size(); ++i) {
      const Pslg::Segment& s = pslg.segments[to_index(line.segments[i])];
      const std::int32_t from = line.points[i], to = line.points[(i + 1) % line.points.size()];
      CHECK(((s.a == from && s.b == to) || (s.a == to && s.b == from)));
    }
    if (line.closed) std::rotate(line.points.begin(), std::ranges::min_element(line.points), line.points.end());
    if (line.closed ? line.points.back() < line.points[1] : line.points.back() < line.points.front())
      std::reverse(line.points.begin() + (line.closed ? 1 : 0), line.points.end());
    if (line.closed) line.points.push_back(-1);
    all.push_back(line.points);
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace

TEST_CASE("a point is on a segment between its ends alone") {
  const Point a{0, 0}, b{4, 0};
  CHECK(on_segment({2, 0}, a, b, 0.1) == OnSegment::kExactly);
  CHECK(on_segment({2, 0.09}, a, b, 0.1) == OnSegment::kClosely);
  CHECK(on_segment({2, 0.11}, a, b, 0.1) == OnSegment::kNo);
  CHECK(on_segment({4.05, 0.01}, a, b, 0.1) == OnSegment::kNo);  // beyond the end
  CHECK(on_segment({-0.05, 0.01}, a, b, 0.1) == OnSegment::kNo);
  CHECK(on_segment({3.95, 0.01}, a, b, 0.1) == OnSegment::kNo);  // close to the end
  CHECK(on_segment({3.85, 0.01}, a, b, 0.1) == OnSegment::kClosely);
}

TEST_CASE("crossings are coordinates that an input can have") {
  constexpr double kTiny = 0x1p-160;
  const Point crossing = crossing_point({0, 0}, {3 * kTiny, kTiny}, {kTiny, 0}, {2 * kTiny, 3 * kTiny});
  CHECK(in_coordinate_range(crossing.x));
  CHECK(in_coordinate_range(crossing.y));
  CHECK(crossing.x > kTiny);
  CHECK(crossing_point({0, 0}, {4, 4}, {0, 4}, {4, 0}) == Point{2, 2});
  const Point between =
      crossing_point({0, 0}, {3 * kInputGrid, 0}, {kInputGrid, kInputGrid}, {2 * kInputGrid, -kInputGrid});
  CHECK(between.x == rounded_to(between.x, kInputGrid));
  CHECK(between.y == 0);
}

TEST_CASE("the frame of a grid is land, however large islands have to be") {
  Grid grid{6, 6, 1, std::vector<double>(36, -1)};
  grid.values[grid.index(2, 2)] = 1;  // an island of one point
  keep_main_basin(grid, 100);
  for (std::size_t i = 0; i < 36; ++i) CHECK(grid.negative(i) == !grid.on_frame(i));
}

TEST_CASE("a contour is closed, and encloses an area") {
  ContourLoop square;
  for (const Point& p : {Point{1, 1}, Point{3, 1}, Point{3, 4}, Point{1, 4}}) square.vertices.push_back({p});
  CHECK(twice_signed_area(square) == 12);
  std::ranges::reverse(square.vertices);
  CHECK(twice_signed_area(square) == -12);
}

TEST_CASE("the ring around a point is the outer border of its part") {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  add_ring(pslg, {{2, 2}, {4, 2}, {4, 4}, {2, 4}});      // an island
  add_ring(pslg, {{20, 0}, {21, 0}, {21, 1}, {20, 1}});  // beside
  pslg.points.push_back({10, 5});
  pslg.points.push_back({12, 5});  // a square with a bar that leads out of it
  pslg.segments.push_back({12, 13, 1});
  pslg.segments[1] = {1, 12, 1};
  pslg.segments.push_back({12, 2, 1});
  const EnclosingRings rings(pslg);
  REQUIRE(rings.around({1, 1}));
  CHECK(rings.around({1, 1})->area == 100);
  CHECK(rings.around({1, 1})->length == 40);
  REQUIRE(rings.around({7, 3}));  // the island lies to the left
  CHECK(rings.around({7, 3})->area == 100);
  REQUIRE(rings.around({1, 3}));  // and to the right
  CHECK(rings.around({1, 3})->area == 100);
  REQUIRE(rings.around({3, 3}));
  CHECK(rings.around({3, 3})->area == 4);
  CHECK(rings.around({3, 3})->length == 8);
  REQUIRE(rings.around({20.5, 0.5}));
  CHECK(rings.around({20.5, 0.5})->area == 1);
  CHECK_FALSE(rings.around({15, 5}));
  CHECK_FALSE(rings.around({11, 6}));
  CHECK_FALSE(rings.around({-1, 5}));
}

TEST_CASE("lines end where something changes") {
  using Lines = std::vector<std::vector<std::int32_t>>;
  Pslg square;
  add_ring(square, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  CHECK(lines_of(square) == Lines{{0, 1, 2, 3, -1}});
  Pslg marked = square;
  marked.segments[1].marker = 2;
  CHECK(lines_of(marked) == Lines{{1, 0, 3, 2}, {1, 2}});
  Pslg point = square;
  point.point_markers = {5, 5, 6, 5};
  CHECK(lines_of(point) == Lines{{1, 0, 3}, {1, 2}, {2, 3}});
  Pslg barred = square;  // a closed line with a corner that stays
  barred.points.push_back({2, 2});
  barred.segments.push_back({2, 4, 1});
  CHECK(lines_of(barred).size() == 2);
  CHECK(polylines_of(barred)[0].points.size() == 5);
  CHECK_FALSE(polylines_of(barred)[0].closed);
  Pslg chain;  // its first segment is in the middle
  chain.points = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
  chain.segments = {{2, 3, 1}, {1, 0, 1}, {1, 2, 1}, {3, 4, 1}, {5, 4, 1}};
  CHECK(lines_of(chain) == Lines{{0, 1, 2, 3, 4, 5}});
}

TEST_CASE("rings lose repetitions") {
  const auto dropped = [](Pslg::Ring ring) {
    drop_repetitions(ring);
    return ring;
  };
  CHECK(dropped({1, 1, 2, 3, 3, 1}) == Pslg::Ring{1, 2, 3});
  CHECK(dropped({4, 4, 4}).empty());
  CHECK(dropped({}).empty());
}

TEST_CASE("open ends are those of one segment, and a gap is none that a segment spans") {
  Pslg fork;
  fork.points = {{0, 0}, {1, 0}, {2, 1}, {2, -1}, {0.1, 0.5}};
  fork.segments = {{0, 1, 1}, {1, 2, 1}, {1, 3, 1}};
  const OpenBoundary open = find_open_boundary(fork);
  CHECK_FALSE(open.has_loop);
  CHECK(open.open_ends == std::vector<std::int32_t>{0, 2, 3});
  Pslg pair;
  pair.points = {{0, 0}, {1, 0}, {5, 0}};
  pair.segments = {{0, 1, 1}};
  const auto gap = find_gap(pair, {0, 1, 2});
  REQUIRE(gap);
  CHECK(gap->width == 4);
}

TEST_CASE("a name is that of one marker or of one region") {
  Names names;
  add_marker_name(names, 1, "inlet");
  add_region_name(names, 2, "inlet");
  CHECK(names.regions.empty());
  add_region_name(names, 2, "basin");
  add_marker_name(names, 3, "basin");
  CHECK(names.markers.size() == 1);
  CHECK(names.regions.size() == 1);
}

TEST_CASE("seeds are coordinates that an input can have, and snapping is by a length") {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  add_ring(pslg, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  pslg.holes = {{0x1.8p-180, -0.5}};
  pslg.regions = {{{-0.5, 0x1p-180}, 1, 0}};
  Pslg again = pslg;
  repair(pslg);
  CHECK(in_coordinate_range(pslg.holes[0].x));
  CHECK(in_coordinate_range(pslg.regions[0].at.y));
  for (const double snap : {-1.0, -1e-300, HUGE_VAL, std::nan("")})
    CHECK_THROWS_AS(repair(again, "input", {.snap = snap}), Error);
}

TEST_CASE("a domain is read from its own files, and other files are refused by their kind") {
  const TemporaryFolder folder;
  const auto written = [&](const char* name, const char* text) {
    const std::string path = folder.path() / name;
    std::ofstream(path) << text;
    return path;
  };
  const std::string poly = written("a.poly", "0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  CHECK(poly_files(poly) == std::vector<std::string>{poly});
  const std::string node = written("a.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n");
  CHECK(poly_files(poly) == std::vector<std::string>{poly, node});
  CHECK(read_poly(poly).points.size() == 3);
  CHECK(error_text([&] { (void)read_poly(written("b.poly", "$MeshFormat\n4.1 0 8\n")); }).find("and not a domain") !=
        std::string::npos);
}
