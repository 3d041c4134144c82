#include "mesh/size_bound.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/cdt.hpp"
#include "mesh/refiner.hpp"
#include "sizing/time_step.hpp"
#include "small_domains.hpp"

// Bounds of any kinds together. Those that requests have are in property/bounds_property_test.cpp.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Areas by region, as twice those of triangles; a single one everywhere.
class ByLabel final : public SizeBound {
 public:
  explicit ByLabel(std::vector<double> twice_areas) : twice_areas_(std::move(twice_areas)) {}
  [[nodiscard]] std::size_t regions() const override { return twice_areas_.size(); }
  [[nodiscard]] double twice_area(std::uint16_t region) const override {
    if (twice_areas_.size() == 1) return twice_areas_[0];
    return region < twice_areas_.size() ? twice_areas_[region] : kNoBound;
  }

 private:
  std::vector<double> twice_areas_;
};

/// Lengths that grow from a line x = const.
class FromLine final : public SizeBound, private SizeField {
 public:
  explicit FromLine(double x) : x_(x) {}
  [[nodiscard]] const SizeField* lengths() const override { return this; }

 private:
  [[nodiscard]] double edge_length(const Point& p) const override { return 0.02 + 0.1 * std::abs(p.x - x_); }
  [[nodiscard]] double least() const override { return 0.02; }
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override {
    const auto [left, right] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    return at_corners - 0.1 * (right - left);
  }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override {
    const auto [left, right] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    return edge_length({std::clamp(x_, left, right), 0}) < length;
  }

  double x_;
};

const CornerPoints kAside{Point{0.4, 0}, {0.5, 0}, {0.45, 0.1}};

}  // namespace

TEST_CASE("of bounds of several kinds the smallest counts, in each region and at each place") {
  const SizeBounds none{SizeKinds{}};
  CHECK(!none.any());
  CHECK(none.regions() == 1);
  CHECK(none.twice_area(0) == kNoBound);
  const SizeBounds sizes({std::make_shared<ByLabel>(std::vector<double>{4}), std::make_shared<FromLine>(0.2),
                          std::make_shared<ByLabel>(std::vector<double>{kNoBound, 3, 5}),
                          std::make_shared<FromLine>(0.8)});
  CHECK(sizes.any());
  CHECK(sizes.regions() == 3);
  CHECK(sizes.twice_area(0) == 4);
  CHECK(sizes.twice_area(1) == 3);
  CHECK(sizes.twice_area(2) == 4);
  CHECK(sizes.twice_area(7) == 4);  // the other kind does not know of it
  CHECK(sizes.least_twice_area() == 3);
  CHECK(sizes.by_place());
  CHECK(sizes.length_at({0.3, 9}) == doctest::Approx(0.03));
  CHECK(sizes.length_at({0.9, 9}) == doctest::Approx(0.03));
  CHECK(sizes.least_length() == 0.02);
  CHECK(sizes.least_between(kAside, 0.04) == doctest::Approx(0.03));
  CHECK(sizes.falls_below(kAside, 0.0401));
  CHECK(!sizes.falls_below(kAside, 0.0399));
}

TEST_CASE("coarser bounds allow larger triangles everywhere") {
  const SizeBounds sizes({std::make_shared<ByLabel>(std::vector<double>{4, 3}), std::make_shared<FromLine>(0.2)});
  const SizeBounds coarse = sizes.coarser(4);
  CHECK(coarse.twice_area(0) == 16);
  CHECK(coarse.twice_area(1) == 12);
  CHECK(coarse.length_at({0.3, 0}) == doctest::Approx(0.06));
  CHECK(coarse.least_length() == 0.04);
  CHECK(coarse.least_between(kAside, 0.08) == doctest::Approx(0.06));
  CHECK(coarse.falls_below(kAside, 0.0801));
  CHECK(!coarse.falls_below(kAside, 0.0799));
  CHECK(coarse.coarser(0.25).twice_area(1) == 3);
}

TEST_CASE("refinement and its forecast obey kinds that no request has") {
  const SizeBounds sizes({std::make_shared<ByLabel>(std::vector<double>{0.003}), std::make_shared<FromLine>(0.2),
                          std::make_shared<FromLine>(0.8)});
  Triangulation mesh = triangulate(rectangle(1, 1));
  const double forecast = BoundForecast(mesh, sizes).total();
  CHECK(Refiner(mesh, 20, sizes).refine() == Refiner::Status::kDone);
  check_valid(mesh);
  CHECK(static_cast<double>(mesh.live_triangles()) == doctest::Approx(forecast).epsilon(0.2));
  double smallest = 1, largest = 0;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const CornerPoints corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const double twice_area = 2 * signed_area(corners[0], corners[1], corners[2]);
    smallest = std::min(smallest, twice_area);
    largest = std::max(largest, twice_area);
    for (const Point& p : corners) CHECK(twice_area <= twice_area_of_edge(sizes.length_at(p)));
    CHECK(!sizes.falls_below(corners, edge_of_twice_area(twice_area)));
  }
  CHECK(largest <= 0.003);
  CHECK(smallest < largest / 4);
}

TEST_CASE("a bound that is not a number is refused") {
  QualityBounds bounds;
  bounds.plain.area = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(SizeBounds{bounds}, doctest::Contains("not a number"), Error);
  Triangulation mesh = triangulate(rectangle(1, 1));
  CHECK_THROWS_AS(Refiner(mesh, bounds), Error);
}

TEST_CASE("coarser bounds are for work to be estimated: larger by a factor, and without a time step") {
  const SizeBounds bounds({std::make_shared<ByLabel>(std::vector<double>{1, 4}), std::make_shared<FromLine>(0.5)});
  const SizeBounds coarse = bounds.coarser(9);
  for (const std::size_t label : {0, 1}) CHECK(coarse.twice_area(label) == 9 * bounds.twice_area(label));
  for (const double x : {0.0, 0.5, 2.0})
    CHECK(coarse.length_at({x, 1}) == doctest::Approx(3 * bounds.length_at({x, 1})));
  const TimeStep step({}, nullptr);
  QualityBounds with_step;
  with_step.step = &step;
  CHECK(SizeBounds(with_step).step() == &step);
  CHECK(SizeBounds(with_step).coarser(9).step() == nullptr);
}
