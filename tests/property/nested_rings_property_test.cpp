#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "driftmesh/repair.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/nested_rings.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/warnings_of.hpp"

// Random trees of rings inside rings: what is known from how they are made against what is found in the triangulation.

using namespace driftmesh;
using testing::warnings_of;

namespace {

/// Stars inside discs that lie inside other stars.
struct RingTree {
  Pslg input;
  double area = 0;  ///< area of the domain if rings alternate
  std::size_t inner_rings = 0;

  RingTree(std::uint64_t seed, double scale, double shift) : random_(seed), scale_(scale), shift_(shift) {
    add({0, 0}, 1, 1);
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  /// A ring between 0.6 of the radius and the radius, and rings inside it.
  void add(const Point& center, double radius, int depth) {
    const auto first = static_cast<std::int32_t>(input.points.size());
    const auto corners = static_cast<std::int32_t>(3 + random_() % 8);
    const double turn = 2 * std::numbers::pi * unit();
    double twice_area = 0;
    for (std::int32_t i = 0; i < corners; ++i) {
      const double angle = turn + 2 * std::numbers::pi * i / corners, r = radius * (0.6 + 0.4 * unit());
      input.points.push_back(
          {shift_ + scale_ * (center.x + r * std::cos(angle)), shift_ + scale_ * (center.y + r * std::sin(angle))});
      input.segments.push_back({first + i, first + (i + 1) % corners, depth});
    }
    for (std::int32_t i = 0; i < corners; ++i) {
      const Point &a = input.points[first + i], &b = input.points[first + (i + 1) % corners];
      twice_area += (a.x - shift_) * (b.y - shift_) - (b.x - shift_) * (a.y - shift_);
    }
    area += (depth % 2 == 1 ? 1 : -1) * twice_area / 2;
    inner_rings += depth > 1;
    if (depth == 5) return;
    // A star of three corners at 0.6 of the radius still holds a disc of 0.3 of it.
    const double inner = 0.29 * radius;
    for (int k = 0; k < 4; ++k)
      if (const double angle = k * std::numbers::pi / 2; random_() % 3 == 0)
        add({center.x + 0.55 * inner * std::cos(angle), center.y + 0.55 * inner * std::sin(angle)}, 0.3 * inner,
            depth + 1);
  }

  std::mt19937_64 random_;
  double scale_, shift_;
};

double area_of(const Pslg& pslg) {
  const Triangulation mesh = triangulate(pslg);
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) area += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return area;
}

}  // namespace

TEST_CASE("rings in rings alternate between holes and islands, whatever their shape and scale") {
  std::mt19937_64 random = testing::seeded_generator("nested rings");
  std::size_t inner = 0;
  for (std::int64_t i = 0; testing::more_cases(i, 400, inner > 100); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    const double scale = std::pow(10, static_cast<double>(seed % 13) - 6);
    RingTree tree(seed, scale, seed % 3 == 0 ? 0 : 7 * scale);
    inner += tree.inner_rings;
    const NestedRings found = find_nested_rings(triangulate(tree.input));
    CHECK(found.unexplained.size() == tree.inner_rings);
    Pslg nested = tree.input;
    nested.holes = found.alternating_holes;
    CHECK(area_of(nested) == doctest::Approx(tree.area).epsilon(1e-9));
    CHECK(find_nested_rings(triangulate(nested)).unexplained.empty());
  }
}

TEST_CASE("rings with holes or region points inside are as their author meant them") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    RingTree tree(seed, 1, 0);
    CHECK(warnings_of(tree.input).size() == (tree.inner_rings > 0 ? 1 : 0));
    Pslg regions = tree.input;
    for (const Point& p : find_nested_rings(triangulate(tree.input)).alternating_holes)
      regions.regions.push_back({p, 1, -1});
    const NestedRings found = find_nested_rings(triangulate(regions));
    CHECK(found.alternating_holes.empty());
    CHECK(found.unexplained.size() == tree.inner_rings - regions.regions.size());
  }
}

TEST_CASE("domains that are known to be complete give no warning") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
    shape.rings = 0;  // those may have no region point
    const oracles::RandomPslg random = oracles::make_random_pslg(seed, shape);
    CHECK(warnings_of(random.input).empty());
  }
}
