#include "mesh/nested_rings.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "driftmesh/repair.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/blocks.hpp"
#include "mesh/cdt.hpp"
#include "support/rings.hpp"

using namespace driftmesh;
using driftmesh::testing::pslg_of_rings;

namespace {

double nested_area(Pslg pslg) {
  static_cast<void>(repair(pslg));
  for (const Point& hole : find_nested_rings(triangulate(pslg)).alternating_holes) pslg.holes.push_back(hole);
  const Triangulation mesh = triangulate(pslg);
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) area += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return area;
}

const std::vector<Point> kBoundary{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
const std::vector<Point> kAtCorner{{0, 0}, {4, 3}, {6, 6}, {3, 4}};  // area 6

}  // namespace

TEST_CASE("blocks are what remains connected without any of its points") {
  // Two triangles that share point 2, a bridge from there to 5, and a square with a diagonal at its end.
  const Blocks blocks =
      blocks_of(9, {{0, 1}, {2, 3}, {1, 2}, {2, 5}, {2, 0}, {3, 4}, {4, 2}, {5, 6}, {6, 7}, {7, 8}, {8, 5}, {5, 7}});
  REQUIRE(blocks.edges.size() == 4);
  CHECK(blocks.edges[BlockId{0}] == std::vector<std::int32_t>{0, 2, 4});
  CHECK(blocks.edges[BlockId{1}] == std::vector<std::int32_t>{1, 5, 6});
  CHECK(blocks.edges[BlockId{2}] == std::vector<std::int32_t>{3});
  CHECK(blocks.edges[BlockId{3}] == std::vector<std::int32_t>{7, 8, 9, 10, 11});
  CHECK(blocks.of_edge[6] == BlockId{1});
  CHECK(blocks_of(2, {}).edges.empty());
}

TEST_CASE("nested rings that touch at a point are rings of their own") {
  CHECK(nested_area(pslg_of_rings({kBoundary, kAtCorner})) == doctest::Approx(94));
  // A ring that touches at its leftmost point, and one inside that touches both there.
  CHECK(nested_area(pslg_of_rings({kBoundary, {{0, 5}, {8, 2}, {8, 8}}, {{0, 5}, {6, 4}, {6, 6}}})) ==
        doctest::Approx(100 - 24 + 6));
  // A chain of rings, each at the end of the one before.
  CHECK(nested_area(pslg_of_rings({kBoundary,
                                   {{2, 2}, {4, 2}, {4, 4}, {2, 4}},
                                   {{4, 4}, {6, 4}, {6, 6}, {4, 6}},
                                   {{6, 6}, {8, 6}, {8, 8}, {6, 8}}})) == doctest::Approx(88));
}

TEST_CASE("nested rings that touch at two points, or cross, alternate where no segment is shared") {
  CHECK(nested_area(pslg_of_rings({kBoundary, {{0, 0}, {6, 4}, {10, 10}, {4, 6}}})) == doctest::Approx(100 - 20));
  CHECK(nested_area(pslg_of_rings({kBoundary, {{5, 5}, {15, 5}, {15, 15}, {5, 15}}})) == doctest::Approx(200 - 50));
  CHECK(nested_area(pslg_of_rings({kBoundary, {{5, 0}, {10, 5}, {5, 10}, {0, 5}}, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}})) ==
        doctest::Approx(100 - 50 + 4));
}

TEST_CASE("a segment that ties a ring to the boundary does not change what it is") {
  Pslg tied = pslg_of_rings({kBoundary, {{4, 4}, {6, 4}, {6, 6}, {4, 6}}});
  tied.segments.push_back({0, 4, 1});
  CHECK(nested_area(tied) == doctest::Approx(96));
  Pslg halves = pslg_of_rings({kBoundary});
  halves.segments.push_back({0, 2, 1});
  CHECK(nested_area(halves) == doctest::Approx(100));
}
