#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "adapt/overlap_integrals.hpp"
#include "adapt/overlaps.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "support/rings.hpp"

// Overlaps of two meshes of one polygon.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Triangulation refined(const Pslg& pslg, double area) {
  Triangulation mesh = triangulate(pslg);
  QualityBounds bounds;
  bounds.plain.area = area;
  Refiner(mesh, bounds).refine();
  return mesh;
}

Triangulation refined(const std::vector<Point>& ring, double area) {
  Pslg pslg;
  add_ring(pslg, ring);
  return refined(pslg, area);
}

Triangulation pentagon(double area) {
  return refined(std::vector<Point>{{0, 0}, {4, -1}, {6, 2}, {3, 5}, {-1, 3}}, area);
}

double area_of(const Triangulation& mesh, TriangleId t) {
  return signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// How far the sum of the overlaps of a triangle is from its area, at most, and in proportion to it: old and new ones.
std::pair<double, double> worst_sums(const Triangulation& before, const Triangulation& after) {
  std::pair<double, double> worst;
  adapt::OverlapSearch search(before, after);
  adapt::Overlaps found;
  IdVector<TriangleId, double> covered(after.triangles.size(), 0);
  for (const TriangleId t : ids_of(before.triangles)) {
    if (!before.triangles[t].alive()) continue;
    search.find(t, found);
    double sum = 0;
    for (const adapt::Overlap& o : found.list) {
      sum += o.area;
      covered[o.new_triangle] += o.area;
    }
    worst.first = std::max(worst.first, std::fabs(sum / area_of(before, t) - 1));
  }
  for (const TriangleId t : ids_of(after.triangles))
    if (after.triangles[t].alive())
      worst.second = std::max(worst.second, std::fabs(covered[t] / area_of(after, t) - 1));
  return worst;
}

}  // namespace

TEST_CASE("overlaps of a triangle are all of it, of old ones as of new ones") {
  for (const auto& [area_before, area_after] : {std::pair{0.3, 0.011}, {0.011, 0.3}, {0.05, 0.04}}) {
    CAPTURE(area_before);
    const auto [of_old, of_new] = worst_sums(pentagon(area_before), pentagon(area_after));
    CHECK(of_old < 1e-13);
    CHECK(of_new < 1e-13);
  }
}

TEST_CASE("overlaps of a triangle are all of it far from the origin, too") {
  const double x = 500'000, y = 6'000'000;  // meters, as in a zone of UTM
  const std::vector<Point> square{{x, y}, {x + 8, y}, {x + 8, y + 8}, {x, y + 8}};
  for (const auto& [area_before, area_after] : {std::pair{0.03, 0.011}, {0.011, 0.03}}) {
    CAPTURE(area_before);
    const auto [of_old, of_new] = worst_sums(refined(square, area_before), refined(square, area_after));
    CHECK(of_old < 1e-13);
    CHECK(of_new < 1e-13);
  }
}

TEST_CASE("overlaps are those of the same triangle whatever was looked at before") {
  const Triangulation before = pentagon(0.3), after = pentagon(0.11);
  adapt::OverlapSearch search(before, after);
  adapt::Overlaps first, again;
  for (const TriangleId t : ids_of(before.triangles)) {
    if (!before.triangles[t].alive()) continue;
    search.find(t, first);
    adapt::OverlapSearch(before, after).find(t, again);
    REQUIRE(first.list.size() == again.list.size());
    for (std::size_t i = 0; i < first.list.size(); ++i) {
      const adapt::Overlap &a = first.list[i], &b = again.list[i];
      CHECK(a.new_triangle == b.new_triangle);
      CHECK(a.area == b.area);
      CHECK(std::ranges::equal(first.polygon(a), again.polygon(b)));
    }
  }
}

TEST_CASE("triangles that stay have no overlaps, whatever rounding says") {
  const Triangulation before = pentagon(0.3), after = pentagon(0.11);
  adapt::Descent descent;
  descent.same.resize(after.triangles.size(), kNone);
  const IdVector<VertexId, std::int32_t> places;
  const adapt::Lineage::Change change{SubdomainId{0}, false, before, after, descent, {}, {}, places, places};
  const auto overlaps_with_new = [&](TriangleId t) {
    std::ptrdiff_t count = 0;
    adapt::visit_overlaps(change, [&](const adapt::Overlaps& overlaps) {
      count += std::ranges::count(overlaps.list, t, &adapt::Overlap::new_triangle);
    });
    return count;
  };
  const auto overlaps_of_old = [&](TriangleId t) {
    std::size_t count = 0;
    adapt::visit_overlaps(change, [&](const adapt::Overlaps& overlaps) {
      if (overlaps.old_triangle == t) count += overlaps.list.size();
    });
    return count;
  };
  const TriangleId old{7}, made{0};
  CHECK(overlaps_of_old(old) > 1);
  CHECK(overlaps_with_new(made) > 1);
  descent.same[made] = old;  // far more than rounding
  CHECK(overlaps_of_old(old) == 0);
  CHECK(overlaps_with_new(made) == 0);
}

TEST_CASE("overlaps of old triangles in the second part of a subdomain are found, too") {
  const auto squares = [](double area) {
    Pslg pslg;
    add_ring(pslg, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    add_ring(pslg, {{3, 0}, {4, 0}, {4, 1}, {3, 1}});
    return refined(pslg, area);
  };
  const Triangulation before = squares(0.03), after = squares(0.01);
  adapt::Descent descent;
  descent.same.resize(after.triangles.size(), kNone);
  const IdVector<VertexId, std::int32_t> places;
  const adapt::Lineage::Change change{SubdomainId{0}, false, before, after, descent, {}, {}, places, places};
  double area = 0;
  adapt::visit_overlaps(change, [&](const adapt::Overlaps& overlaps) {
    for (const adapt::Overlap& o : overlaps.list) area += o.area * overlaps.correction;
  });
  CHECK(area == doctest::Approx(2).epsilon(1e-13));
}
