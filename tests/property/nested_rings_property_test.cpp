#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/nested_rings.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/warnings_of.hpp"
#include "verify/domain.hpp"

// Random trees of rings inside rings: what is known from how they are made against what is found in the triangulation;
// rings that touch, overlap and cross: what the verifier finds from face to face against that.

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

namespace {

/// Triangles, quadrilaterals and lines with corners on a small grid inside a square, so that many share corners and
/// parts of their sides, or cross; hole points and regions anywhere.
Pslg random_grid_rings(std::mt19937_64& random) {
  const auto below = [&](std::uint64_t n) { return static_cast<std::int32_t>(random() % n); };
  const std::int32_t width = 4 + below(8);
  Pslg input;
  const auto add_ring = [&](const std::vector<Point>& corners) {
    const auto first = static_cast<std::int32_t>(input.points.size()), n = static_cast<std::int32_t>(corners.size());
    input.points.insert(input.points.end(), corners.begin(), corners.end());
    for (std::int32_t i = 0; i < (n > 2 ? n : 1); ++i) input.segments.push_back({first + i, first + (i + 1) % n, 0});
  };
  const auto on_grid = [&](double from, double to) {
    return Point{from + below(static_cast<std::uint64_t>(to - from) + 1),
                 from + below(static_cast<std::uint64_t>(to - from) + 1)};
  };
  const auto w = static_cast<double>(width);
  add_ring({{0, 0}, {w, 0}, {w, w}, {0, w}});
  for (std::int32_t rings = 1 + below(6); rings > 0; --rings) {
    if (random() % 3 == 0) {
      const double d = 1 + below(static_cast<std::uint64_t>(width) / 2);
      add_ring({{d, d}, {w - d + 0.5, d}, {w - d + 0.5, w - d + 0.5}, {d, w - d + 0.5}});
      continue;
    }
    std::vector<Point> corners;
    for (std::int32_t n = 2 + below(3); n > 0; --n) corners.push_back(on_grid(0, w));
    add_ring(corners);
  }
  const auto place = [&] { return Point{w * (below(997) + 0.31) / 997, w * (below(991) + 0.17) / 991}; };
  if (random() % 3 == 0) input.holes.push_back(place());
  if (random() % 3 == 0) input.regions.push_back({place(), 1, -1});
  return input;
}

}  // namespace

TEST_CASE("the verifier's holes between rings are the mesher's, whatever touches, overlaps and crosses") {
  std::mt19937_64 random = testing::seeded_generator("rings on a grid");
  std::size_t alternating = 0, touching = 0;
  for (std::int64_t i = 0; testing::more_cases(i, 3000, alternating > 200 && touching > 100); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 drawn(seed);
    Pslg input = random_grid_rings(drawn);
    try {
      repair(input, "input");
    } catch (const Error&) {
      continue;  // nothing is left of it
    }
    Pslg rings = input;
    rings.holes.clear();
    Pslg nested = input;
    const std::vector<Point> found = find_nested_rings(triangulate(rings)).alternating_holes;
    nested.holes.insert(nested.holes.end(), found.begin(), found.end());
    const Domain judged(input, HoleRule::kNested);
    REQUIRE(!judged.conflict());
    alternating += !found.empty();
    touching += found.size() > 1;
    const double area = judged.area();
    if (area == 0) continue;
    CAPTURE(oracles::poly_text(input));
    CAPTURE(oracles::poly_text(nested));
    CHECK(area == doctest::Approx(Domain(nested).area()).epsilon(1e-12));
    CHECK(judged.euler_number() == Domain(nested).euler_number());
  }
}
