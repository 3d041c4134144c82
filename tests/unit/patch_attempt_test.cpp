#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "patch/attempt.hpp"

// Where a domain that replaces a part of a mesh needs more room.

using namespace driftmesh;

namespace {

/// A rectangle of width 1 on an edge that nothing may split, with an old point so high above the middle of the edge:
/// the points around which triangles are too large although all bounds on area are the same.
std::vector<std::int32_t> tight_points(double height, double most_area) {
  patch::Part part;
  part.mesh.points = {{0, 0}, {1, 0}, {1, 2}, {0, 2}, {0.5, height}};
  part.mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  part.triangle = {0, 1, 2, 3};
  part.point = {0, 1, 2, 3, 4};
  part.beyond.assign(4, {-1, -1, -1});
  patch::Extent extent;
  extent.taken.assign(4, true);
  extent.inside.assign(4, true);
  extent.held.assign(5, true);
  patch::Domain domain;
  domain.pslg.points = part.mesh.points;
  domain.pslg.point_markers.assign(5, 0);
  domain.pslg.segments = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {0, 3, 0}};
  domain.sides = {{0, kNone}, {0, kNone}, {0, kNone}, {kNone, 0}};
  domain.fixed = {true, false, false, false};
  domain.free.assign(5, false);
  QualityBounds bounds{.min_angle = 0};
  bounds.plain.area = most_area;
  const std::vector<const SizeField*> none{nullptr};
  return patch::attempt(domain, part, extent, patch::OldPlaces(part.mesh), bounds,
                        {.sizes = none, .most_triangles = 10'000})
      .tight;
}

}  // namespace

TEST_CASE("around an edge that may not be split the old points next to large triangles are tight") {
  using Points = std::vector<std::int32_t>;
  CHECK(tight_points(0.4, 1).empty());
  // No point comes to the lens above the edge, which ends at 0.29, so triangles that reach into it stay too large. Most
  // of them have no old point: then that which is nearest counts.
  for (const double height : {0.36, 0.39, 0.42, 0.44}) {
    CAPTURE(height);
    CHECK(tight_points(height, 0.00148) == Points{0, 1, 4});
  }
  CHECK(tight_points(1.5, 0.00148) == Points{0, 1});
}
