#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adapt/overlap_integrals.hpp"
#include "adapt/overlaps.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "support/rings.hpp"

// Overlaps of two meshes of one polygon, some at a time.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Triangulation refined(const std::vector<Point>& ring, double area) {
  Pslg pslg;
  add_ring(pslg, ring);
  Triangulation mesh = triangulate(pslg);
  QualityBounds bounds;
  bounds.plain.area = area;
  Refiner(mesh, bounds).refine();
  return mesh;
}

Triangulation pentagon(double area) {
  return refined({{0, 0}, {4, -1}, {6, 2}, {3, 5}, {-1, 3}}, area);
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

TEST_CASE("overlaps of a new triangle are all of it far from the origin, too") {
  const double x = 500'000, y = 6'000'000;  // meters, as in a zone of UTM
  const std::vector<Point> square{{x, y}, {x + 8, y}, {x + 8, y + 8}, {x, y + 8}};
  const Triangulation before = refined(square, 0.03), after = refined(square, 0.011);
  adapt::OverlapList all;
  REQUIRE(adapt::OverlapFinder(before, after, is_any).find(1'000'000, all));
  IdVector<TriangleId, double> covered(after.triangles.size(), 0);
  for (const adapt::Overlap& o : all.overlaps) covered[o.new_triangle] += o.area;
  double worst = 0;
  for (const TriangleId t : ids_of(after.triangles)) {
    if (!after.triangles[t].alive()) continue;
    const double area = signed_area(after.corner(t, 0), after.corner(t, 1), after.corner(t, 2));
    worst = std::max(worst, std::fabs(covered[t] - area) / area);
  }
  CHECK(worst < 1e-14);
}

TEST_CASE("triangles that stay have no overlaps, whatever rounding says") {
  const Triangulation before = pentagon(0.3), after = pentagon(0.11);
  adapt::Descent descent;
  descent.same.resize(after.triangles.size(), kNone);
  const IdVector<VertexId, std::int32_t> places;
  const adapt::Lineage::Change change{SubdomainId{0}, false, before, after, descent, {}, {}, places, places};
  const auto overlaps_of_old = [&](TriangleId old) {
    adapt::Overlaps overlaps(change, {});
    std::ptrdiff_t count = 0;
    while (overlaps.next()) count += std::ranges::count(overlaps.found.overlaps, old, &adapt::Overlap::old_triangle);
    return count;
  };
  const TriangleId some{7};
  CHECK(overlaps_of_old(some) > 1);
  descent.same[TriangleId{0}] = some;  // far more than rounding
  CHECK(overlaps_of_old(some) == 0);
}
