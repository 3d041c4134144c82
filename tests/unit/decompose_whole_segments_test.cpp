#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "decompose/bridges.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/cutter.hpp"
#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "support/prepared_mesh.hpp"
#include "support/rings.hpp"

// Where separators end only at points of the domain, there is little room for cuts: a right triangle with equal legs
// cannot be cut at all, and a square only along a diagonal.

using namespace driftmesh;
using driftmesh::testing::prepared;
using driftmesh::testing::pslg_of_rings;

namespace {

using Corners = std::vector<Point>;

Corners right_triangle(double legs, double x = 0) {
  return {{x, 0}, {x + legs, 0}, {x, legs}};
}

/// A rectangle that stands on the x-axis.
Corners box_at(double x, double width, double height) {
  return {{x, 0}, {x + width, 0}, {x + width, height}, {x, height}};
}

Decomposition cut_at_corners(const std::vector<Corners>& polygons, std::int32_t subdomains) {
  return decompose(prepared(pslg_of_rings(polygons)), {.subdomains = subdomains, .bounds = {}, .whole_segments = true});
}

std::vector<double> ascending_areas(const Decomposition& d) {
  std::vector<double> areas;
  for (const Decomposition::Subdomain& s : d.subdomains) areas.push_back(s.area);
  std::ranges::sort(areas);
  return areas;
}

}  // namespace

TEST_CASE("a domain that cannot be cut into so many is refused, with the number that it can be cut into") {
  CHECK(cut_at_corners({right_triangle(1)}, 1).size() == 1);
  CHECK_THROWS_WITH_AS(cut_at_corners({right_triangle(1)}, 2), doctest::Contains("could be cut into 1 of 2 subdomains"),
                       Error);
  CHECK_THROWS_WITH_AS(cut_at_corners({right_triangle(2), right_triangle(1, 3)}, 4),
                       doctest::Contains("could be cut into 2 of 4 subdomains"), Error);
}

TEST_CASE("the parts that a heavy piece cannot be cut into go to one that can be cut") {
  // By area the triangle is due 2.34 of three subdomains, and the square 0.66.
  const Decomposition d = cut_at_corners({right_triangle(2), box_at(3, 0.75, 0.75)}, 3);
  CHECK(ascending_areas(d) == std::vector<double>{0.28125, 0.28125, 2});
}

TEST_CASE("a heavy piece that cannot be divided stays one part, and one that can becomes two of one part each") {
  PlanarMap map = connected_walls(prepared(pslg_of_rings({right_triangle(2), box_at(3, 2, 2)})), 10, 1);
  map.whole_segments = true;
  IdVector<PieceId, Piece> pieces = find_pieces(map, QualityBounds{});
  REQUIRE(pieces.size() == 2);
  for (Piece& piece : pieces) piece.parts = 1;
  IdVector<PieceId, WorkSamples> samples(pieces.size());
  Cutter(map, pieces, samples, {}, 2).divide(1);
  std::vector<double> areas;
  for (const Piece& piece : pieces) {
    CHECK(piece.parts == 1);
    areas.push_back(piece.area);
  }
  CHECK(areas == std::vector<double>(3, 2));
}

TEST_CASE("of all attempts at an even cut the fairest is kept") {
  const Decomposition d = cut_at_corners({{{8, 5}, {2, 6}, {-10, 1}, {-3, -4}, {2, -5}}}, 4);
  CHECK(check_decomposition(d).largest_load < 1.6);  // groups of finer cuts, which are tried last, have 1.9
}

TEST_CASE("where all the work leaves no room for cuts, area counts instead") {
  // The angle bound puts hundreds of triangles into the channel and leaves the two halves of the square, which can be
  // cut, as they are.
  constexpr double kLength = 400, kWidth = 30;
  const Decomposition d = cut_at_corners({box_at(0, kLength, 1), box_at(kLength + 1, kWidth, kWidth)}, 3);
  CHECK(ascending_areas(d) == std::vector<double>{kLength, kWidth * kWidth / 2, kWidth * kWidth / 2});
}
