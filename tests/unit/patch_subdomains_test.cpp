#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "adapt/linear_lengths.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "patch/in_subdomains.hpp"
#include "support/mesh_equality.hpp"
#include "support/rings.hpp"
#include "verify/verify.hpp"

// A domain that is made anew in subdomains.

using namespace driftmesh;

namespace {

/// A plate with a hole, of two regions: left and right of a line.
struct Plate {
  Pslg pslg;
  std::vector<SegmentSides> sides;

  Plate() {
    driftmesh::testing::add_ring(pslg, {{0, 0}, {5, 0}, {10, 0}, {10, 6}, {5, 6}, {0, 6}}, 1);
    sides = {{1, kNone}, {2, kNone}, {2, kNone}, {2, kNone}, {1, kNone}, {1, kNone}};
    driftmesh::testing::add_ring(pslg, {{7, 2}, {7, 3}, {8, 3}, {8, 2}}, 4);  // clockwise: its right side is the hole
    sides.insert(sides.end(), 4, {2, kNone});
    pslg.segments.push_back({1, 4, 9});
    sides.push_back({1, 2});
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (Pslg::Segment& s = pslg.segments[i]; s.a > s.b) {
        std::swap(s.a, s.b);
        std::swap(sides[i].left, sides[i].right);
      }
    pslg.point_markers.assign(pslg.points.size(), 0);
    pslg.regions = {{.at = {}, .attribute = 2.5, .max_area = 0}, {.at = {}, .attribute = 7, .max_area = 0}};
  }
};

/// Lengths that grow from left to right, linear on two triangles around the plate.
struct Growing {
  Triangulation mesh;
  adapt::Lengths lengths;

  Growing() {
    Pslg box;
    driftmesh::testing::add_ring(box, {{-1, -1}, {11, -1}, {11, 7}, {-1, 7}});
    mesh = triangulate(box);
    for (const Point& p : mesh.points) lengths.push_back(0.05 + 0.02 * (p.x + 1));
  }
};

Mesh made_by(std::int32_t threads, std::int64_t most = 1'000'000) {
  const Plate plate;
  const Growing growing;
  std::vector<std::unique_ptr<adapt::LinearLengths>> fields;
  std::vector<const SizeField*> sizes;
  for (std::int32_t i = 0; i < threads; ++i) {
    fields.push_back(std::make_unique<adapt::LinearLengths>(growing.mesh, growing.lengths));
    sizes.push_back(fields.back().get());
  }
  Triangulation domain = triangulate(plate.pslg, plate.sides);
  prepare_corners(domain);
  const QualityBounds bounds{.min_angle = 25, .size = sizes.front()};
  return patch::refine_in_subdomains(domain, plate.pslg, bounds, sizes, 20'000, most);
}

}  // namespace

TEST_CASE("a domain is made anew in subdomains, the same by any number of threads") {
  const Mesh mesh = made_by(1);
  const Plate plate;
  const Growing growing;
  const adapt::LinearLengths size(growing.mesh, growing.lengths);
  const VerifyReport report = verify(mesh, {.min_angle = 25, .size = &size});
  CHECK(report.accepted());
  CHECK(mesh.triangles.size() > 5'000);
  CHECK(std::set(mesh.subdomains.begin(), mesh.subdomains.end()).size() > 20);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double x = 0;
    for (const std::int32_t v : mesh.triangles[t]) x += mesh.points[static_cast<std::size_t>(v)].x / 3;
    CHECK(mesh.regions[t] == (x < 5 ? 2.5 : 7));
  }
  for (const std::int32_t marker : {1, 4, 9}) CHECK(std::ranges::count(mesh.edges, marker, &Mesh::Edge::marker) > 10);
  for (const std::int32_t threads : {2, 3}) test::check_same_mesh(made_by(threads), mesh);
}

TEST_CASE("more triangles than are allowed are one clear error") {
  for (const std::int32_t threads : {1, 2})
    CHECK_THROWS_WITH_AS((void)made_by(threads, 2'000),
                         "lengths ask for more than 2000 triangles in what is made anew; ask for longer ones, or allow "
                         "more triangles",
                         LimitError);
}
