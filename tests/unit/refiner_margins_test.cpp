#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "driftmesh/size_field.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "mesh/worklist.hpp"
#include "small_domains.hpp"

// Triangles that are just at a bound, segments that are just obstructed, and the order of work.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Two triangles of area 1, whose smallest angle is that between the diagonal and the longer sides.
std::size_t triangles_of_two(double angle, double area) {
  Triangulation mesh = triangulate(rectangle(2, 1));
  QualityBounds bounds{.min_angle = angle};
  bounds.plain.area = area;
  CHECK(Refiner(mesh, bounds).refine() == Refiner::Status::kDone);
  return mesh.live_triangles();
}

/// 1, but shorter within a distance of 0.1 from a point.
class Dip final : public SizeField {
 public:
  explicit Dip(const Point& place) : place_(place) {}
  [[nodiscard]] double edge_length(const Point& p) const override {
    return std::hypot(p.x - place_.x, p.y - place_.y) < 0.1 ? 0.1 : 1;
  }

 private:
  Point place_;
};

}  // namespace

TEST_CASE("a triangle that only rounding keeps within a bound is refined, as others may compute it otherwise") {
  const double angle_of_diagonal = std::atan(0.5) * (180 / std::numbers::pi);
  CHECK(triangles_of_two(angle_of_diagonal - 1e-10, 0) > 2);
  CHECK(triangles_of_two(angle_of_diagonal - 1e-6, 0) == 2);
  CHECK(triangles_of_two(20, 1) > 2);
  CHECK(triangles_of_two(20, 1 + 1e-9) == 2);
}

TEST_CASE("a segment is split at once if a point sees it at 120 degrees, or less where the angle bound needs it") {
  // The point is above the middle of the lowest segment, and sees all others at smaller angles.
  const auto splits_at_once = [](double min_angle, double at_apex) {
    Pslg pslg = rectangle(2, 3);
    pslg.points.push_back({1, 1 / std::tan(at_apex / 2 * (std::numbers::pi / 180))});
    Triangulation mesh = triangulate(pslg);
    Refiner refiner(mesh, QualityBounds{.min_angle = min_angle});
    refiner.refine(1);
    return refiner.counters().segment_points == 1 && refiner.counters().encroaching == 0;
  };
  CHECK(splits_at_once(20, 121));
  CHECK(!splits_at_once(20, 119));
  CHECK(!splits_at_once(31, 117));  // 180 - 2 x 31 = 118: below that, the segment does not obstruct the bound
  CHECK(splits_at_once(32, 117));
  CHECK(splits_at_once(33, 115));
  CHECK(!splits_at_once(33, 113));
}

TEST_CASE("a refiner that is done will not look at any triangle but those that change") {
  for (const double area : {0.0, 0.01}) {
    Triangulation mesh = triangulate(rectangle(2, 1));
    QualityBounds bounds;
    bounds.plain.area = area;
    Refiner refiner(mesh, bounds);
    CHECK(!refiner.state().sweep.ended());
    CHECK(refiner.refine() == Refiner::Status::kDone);
    CHECK(refiner.state().sweep.ended());
    CHECK(refiner.state().sweep.places() == Sweep::kEnded);
    for (int slot = 0; slot < 2 * static_cast<int>(mesh.triangles.size()); ++slot)
      REQUIRE(!refiner.state().sweep.will_visit(TriangleId{slot}));
  }
}

TEST_CASE("skinny triangles are taken from the shortest edge to the longest, of the same length the oldest first") {
  SkinnyBuckets buckets;
  const int shorter = SkinnyBuckets::bucket_of(0.25), longer = SkinnyBuckets::bucket_of(4);
  for (const int t : {10, 11, 12, 13}) buckets.add(TriangleId{t}, longer);
  for (const int t : {20, 21, 22, 23}) buckets.add(TriangleId{t}, shorter);
  const auto take = [&] { return to_int(buckets.take().triangle); };
  CHECK(take() == 20);
  CHECK(take() == 21);
  buckets.add(TriangleId{24}, shorter);
  for (const int t : {22, 23, 24, 10, 11, 12, 13}) CHECK(take() == t);
  CHECK(buckets.take().triangle == kNone);
}

TEST_CASE("lengths count at the corners of a triangle and at its centroid, between them only if that is wanted") {
  const Triangulation mesh = triangulate(rectangle(2, 1));
  const CornerPoints corners{Point{0, 0}, {1, 0}, {0.5, 0.75}};
  const auto is_above = [&](const Point& place, bool between) {
    const Dip size(place);
    QualityBounds bounds;
    bounds.size = &size;
    const AreaBounds areas(mesh, SizeBounds(bounds));
    const auto at_corners = [&] {
      double least = kNoBound;
      for (const Point& p : corners) least = std::min(least, size.edge_length(p));
      return least;
    };
    return areas.above_size(corners, twice_area_of_edge(0.9), at_corners, between);
  };
  CHECK(is_above({0, 0}, false));
  CHECK(is_above({0.5, 0.25}, false));  // the centroid
  CHECK(!is_above({0.3, 0.1}, false));
  CHECK(!is_above({5, 5}, true));
}
