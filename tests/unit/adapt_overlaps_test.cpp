#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include "adapt/overlaps.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "support/rings.hpp"

// Overlaps of two meshes of one polygon, some at a time.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Triangulation pentagon(double area) {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {4, -1}, {6, 2}, {3, 5}, {-1, 3}});
  Triangulation mesh = triangulate(pslg);
  QualityBounds bounds;
  bounds.plain.area = area;
  Refiner(mesh, bounds).refine();
  return mesh;
}

bool is_any(TriangleId /*t*/) {
  return true;
}

}  // namespace

TEST_CASE("overlaps that are found some at a time are those that are found at once") {
  const Triangulation before = pentagon(0.3), after = pentagon(0.11);
  adapt::OverlapList all;
  adapt::OverlapFinder at_once(before, after, is_any);
  REQUIRE(at_once.find(1'000'000, all));
  double area = 0;
  for (const adapt::Overlap& o : all.overlaps) area += o.area;
  CHECK(area == doctest::Approx(26));
  CHECK(all.overlaps.size() > 200);
  adapt::OverlapList none = all;
  CHECK(!at_once.find(1'000'000, none));
  CHECK(none.overlaps.size() == all.overlaps.size());  // nothing was put there

  for (const std::size_t most : {1, 7, 100}) {
    adapt::OverlapFinder some_times(before, after, is_any);
    adapt::OverlapList some;
    std::size_t next = 0;
    while (some_times.find(most, some)) {
      const std::size_t first = next;
      for (const adapt::Overlap& o : some.overlaps) {
        REQUIRE(next < all.overlaps.size());
        const adapt::Overlap& same = all.overlaps[next++];
        CHECK(o.old_triangle == same.old_triangle);
        CHECK(o.new_triangle == same.new_triangle);
        CHECK(o.area == same.area);
        CHECK(std::vector(some.polygon(o).begin(), some.polygon(o).end()) ==
              std::vector(all.polygon(same).begin(), all.polygon(same).end()));
      }
      CHECK((next == all.overlaps.size() || next - first >= most));
      if (next < all.overlaps.size())  // nothing of the next one has been taken
        CHECK(all.overlaps[next].new_triangle != all.overlaps[next - 1].new_triangle);
    }
    CHECK(next == all.overlaps.size());
  }
}
