#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "decompose/presplit.hpp"
#include "decompose/work_samples.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/refiner.hpp"
#include "small_domains.hpp"
#include "support/prepared_mesh.hpp"

// What size fields ask of decompositions.

using namespace driftmesh;

namespace {

/// A length near a point, another one elsewhere.
class ShortNear final : public SizeField {
 public:
  ShortNear(const Point& place, double length) : place_(place), length_(length) {}
  [[nodiscard]] double edge_length(const Point& p) const override {
    return std::hypot(p.x - place_.x, p.y - place_.y) < 0.01 ? length_ : 10;
  }

 private:
  Point place_;
  double length_;
};

/// Fine around the unit circle.
class FineCircle final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override {
    return 0.01 + 0.3 * std::abs(std::hypot(p.x, p.y) - 1);
  }
};

}  // namespace

TEST_CASE("interfaces are split for lengths at their ends and in their middle") {
  Decomposition d;
  for (const Point& p : {Point{0, 0}, Point{1, 0}}) d.points.push_back(p);
  d.roots.push_back({.a = GlobalPointId{0}, .b = GlobalPointId{1}, .left = SubdomainId{0}, .right = SubdomainId{1}});
  const auto splits = [&](const Point& place, double length) {
    const ShortNear size(place, length);
    QualityBounds bounds;
    bounds.size = &size;
    return presplit_paths(d, GlobalRootId{0}, bounds);
  };
  using Paths = std::vector<dyadic::Path>;
  const dyadic::Path whole = dyadic::kWhole, first = dyadic::first_half(whole), second = dyadic::second_half(whole);
  CHECK(splits({0.7, 0}, 0.7).empty());
  for (const double x : {0.0, 0.5, 1.0}) {
    CAPTURE(x);
    CHECK(splits({x, 0}, 1.1).empty());
    CHECK(splits({x, 0}, 0.7) == Paths{whole});
  }
  CHECK(splits({0.5, 0}, 0.4) == Paths{whole, first, second});
  CHECK(splits({0.25, 0}, 0.4).empty());  // nobody looks there
}

TEST_CASE("each triangle of the coarse mesh is a sample of the work, but none that has disappeared") {
  const FineCircle size;
  QualityBounds bounds;
  bounds.size = &size;
  bool any_free = false;
  for (unsigned seed = 1; seed <= 100 && !any_free; ++seed) {
    CAPTURE(seed);
    const Triangulation mesh = testing::prepared(testing::fan(seed, 5));
    constexpr double kForecast = 2000, kCount = 50;
    Triangulation coarse = mesh;
    Refiner(coarse, bounds.min_angle, SizeBounds(bounds).coarser(kForecast / kCount)).refine();
    any_free = any_free || coarse.triangles.size() > coarse.live_triangles();
    const WorkSamples samples = sample_work(mesh, bounds, kForecast, kCount);
    CHECK(samples.size() == coarse.live_triangles());
    for (const WorkSample& s : samples) CHECK(std::max(std::fabs(s.at.x), std::fabs(s.at.y)) < 1);
  }
  CHECK(any_free);
}
