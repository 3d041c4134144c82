#include "decompose/smoothing.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "decompose/bridges.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/outline.hpp"
#include "driftmesh/generate.hpp"
#include "mesh/cdt.hpp"
#include "support/prepared_mesh.hpp"

// Separators after smoothing: short, with wide angles, and few interfaces.

using namespace driftmesh;
using driftmesh::testing::prepared;

namespace {

constexpr double kSixty = std::numbers::pi / 3;

Pslg square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  return pslg;
}

SideId side_between(const PlanarMap& map, const Point& a, const Point& b) {
  for (const SideId h : ids_of(map.sides))
    if (map.side(h).in_domain() && map.at(map.start(h)) == a && map.at(map.end(h)) == b) return h;
  FAIL("there is no such side");
  return kNone;
}

SideId split(PlanarMap& map, const Point& a, const Point& b, const Point& m) {
  return map.split(side_between(map, a, b), map.add_point(m, kNone));
}

/// A square of width 2, cut at x = 1 from bottom to top; the left half is cut at `left`, the right one at `right`.
PlanarMap cut_square(double left, double right) {
  PlanarMap map = connected_walls(prepared(square()), 10, kSixty);
  const auto separate = [&](SideId u, SideId v) { (void)map.connect(u, v, PlanarMap::Kind::kSeparator); };
  const SideId bottom = split(map, {0, 0}, {2, 0}, {1, 0}), top = split(map, {2, 2}, {0, 2}, {1, 2});
  separate(bottom, top);
  const SideId west = split(map, {0, 2}, {0, 0}, {0, left}), middle = split(map, {1, 0}, {1, 2}, {1, left});
  separate(west, middle);
  const SideId east = split(map, {2, 0}, {2, 2}, {2, right});
  const SideId opposite =
      right > left ? split(map, {1, 2}, {1, left}, {1, right}) : split(map, {1, left}, {1, 0}, {1, right});
  separate(east, opposite);
  return map;
}

struct Smoothed {
  PlanarMap map;
  IdVector<PieceId, Piece> pieces;
  std::size_t walls = 0;
};

Smoothed smoothed(PlanarMap map) {
  Smoothed result{std::move(map), {}, 0};
  result.pieces = find_pieces(result.map, QualityBounds{});
  const IdRange<SubdomainId> each(result.pieces.size());
  smooth(result.map, result.pieces, {each.begin(), each.end()}, static_cast<std::int32_t>(result.pieces.size()),
         kSixty);
  for (const SideId h : ids_of(result.map.sides))
    result.walls += result.map.side(h).in_domain() && result.map.wall(h).kind == PlanarMap::Kind::kSeparator;
  result.walls /= 2;
  return result;
}

}  // namespace

TEST_CASE("contracting a wall takes it out of both its loops") {
  PlanarMap map = cut_square(0.9, 1.1);
  const SideId wall = side_between(map, {1, 0.9}, {1, 1.1}), back = PlanarMap::twin(wall);
  const SideId left = map.side(wall).next, right = map.side(back).next;
  Loop before_left, before_right, loop;
  read_loop(map, left, before_left);
  read_loop(map, right, before_right);
  map.contract(wall);
  CHECK(!map.side(wall).in_domain());
  CHECK(!map.side(back).in_domain());
  read_loop(map, left, loop);
  CHECK(loop.size() + 1 == before_left.size());
  read_loop(map, right, loop);
  CHECK(loop.size() + 1 == before_right.size());
  for (const SideId h : ids_of(map.sides))
    CHECK((!map.side(h).in_domain() || !(map.at(map.start(h)) == Point{1, 1.1})));
}

TEST_CASE("two places where separators end opposite each other become one") {
  const Smoothed result = smoothed(cut_square(0.9, 1.1));
  CHECK(result.walls == 4);  // 5 before
  double area = 0;
  for (const PieceId i : ids_of(result.pieces)) {
    Loop loop;
    read_loop(result.map, result.pieces[i].side, loop);
    CHECK(area_inside(loop) == doctest::Approx(result.pieces[i].area));
    CHECK(result.pieces[i].work == doctest::Approx(result.pieces[i].area));
    area += result.pieces[i].area;
  }
  CHECK(area == doctest::Approx(4));
}

TEST_CASE("loads become more even") {
  const Smoothed result = smoothed(cut_square(0.6, 1.4));
  for (const Piece& p : result.pieces) CHECK(std::fabs(p.area - 1) < 0.1);  // 0.6 and 1.4 before
}

TEST_CASE("a subdomain has hardly more than four neighbors") {
  const Triangulation mesh = prepared(generate_cylinder_flow({}));
  DecomposeOptions options;
  for (const int n : {100, 1000}) {
    CAPTURE(n);
    options.subdomains = n;
    const Decomposition d = decompose(mesh, options);
    const DecompositionReport report = check_decomposition(d);
    CHECK(report.valid());
    CHECK(report.smallest_angle >= 60 - 1e-9);
    CHECK(report.largest_load <= 1.25);
    CHECK(report.separator_length < 0.979 * (2.06 * std::sqrt(report.area * n) - report.border_length / 2));
    CHECK(static_cast<double>(interfaces(d).size()) < 2.13 * n);  // 2.7 if no two places were one
  }
}
