#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "oracles/grid_mesh.hpp"
#include "oracles/mesh_oracle.hpp"
#include "oracles/random_pslg.hpp"
#include "verify/domain.hpp"

// The oracles detect errors.

using namespace driftmesh;
using namespace driftmesh::oracles;

namespace {

const std::vector<std::string> kRight;

Mesh kite(bool delaunay) {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, -1}, {4, 0}, {2, 1}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  if (delaunay)
    mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  else
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

TEST_CASE("the Delaunay oracle sees a vertex in a circle, unless a subsegment hides it") {
  CHECK(check_constrained_delaunay(kite(true)) == kRight);
  CHECK(check_constrained_delaunay(kite(false)).size() == 2);
  Mesh walled = kite(false);
  walled.edges.push_back({0, 2, 1});
  CHECK(check_constrained_delaunay(walled) == kRight);
}

TEST_CASE("the Delaunay oracle looks through gaps between subsegments") {
  // The eye at (0, -3) is in the circle of the triangle; two walls with a gap between them stand in the way.
  Mesh mesh;
  mesh.points = {{-3, 0}, {3, 0}, {0, 1}, {0, -3}, {-3, -1}, {-0.1, -1}, {0.1, -1}, {3, -1}};
  mesh.triangles = {{0, 1, 2}};
  CHECK(check_constrained_delaunay(mesh).size() == 5);
  mesh.edges = {{4, 5, 0}, {6, 7, 0}};
  const auto with_gap = check_constrained_delaunay(mesh);
  CHECK(std::count_if(with_gap.begin(), with_gap.end(),
                      [](const std::string& s) { return s.find("point 3 ") != std::string::npos; }) == 1);
  mesh.edges = {{4, 7, 0}};
  const auto without = check_constrained_delaunay(mesh);
  CHECK(std::count_if(without.begin(), without.end(),
                      [](const std::string& s) { return s.find("point 3 ") != std::string::npos; }) == 0);
}

TEST_CASE("area, coverage and covering oracles on a correct mesh and on damaged ones") {
  const GridCase right;
  const std::vector<bool> none(right.input.segments.size(), false);
  CHECK(find_boundary(right.mesh).size() == 64);
  CHECK(check_area(right.mesh, find_boundary(right.mesh)) == kRight);
  CHECK(check_coverage(right.mesh, right.input, 0, none) == kRight);
  CHECK(count_covering(right.mesh, {0.5, 0.25}) == 1);
  CHECK(count_covering(right.mesh, {5.5, 4.25}) == 0);
  CHECK(count_covering(right.mesh, {1, 1}) == -1);

  Mesh mesh = right.mesh;
  mesh.triangles.pop_back();
  CHECK(check_area(mesh, find_boundary(right.mesh)) != kRight);
  mesh = right.mesh;
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  CHECK(check_area(mesh, find_boundary(right.mesh)) != kRight);
  mesh = right.mesh;
  mesh.edges.erase(mesh.edges.begin() + 5);
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  mesh = right.mesh;
  mesh.edges.push_back(mesh.edges[5]);
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  mesh = right.mesh;
  ++mesh.edges[5].marker;
  CHECK(check_coverage(mesh, right.input, 0, none) != kRight);
  std::vector<bool> one = none;
  one.back() = true;
  CHECK(check_coverage(right.mesh, right.input, 0, one) != kRight);
}

TEST_CASE("random inputs are planar, and the arrangement finds the boundary that they were made with") {
  int inner = 0, points = 0, dangling = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const RandomPslg random = make_random_pslg(seed, make_random_shape(seed));
    const Domain domain(random.input);
    REQUIRE(!domain.conflict());
    std::size_t boundary = 0;
    for (const auto& s : domain.segments()) boundary += domain.inside(s.left_face) != domain.inside(s.right_face);
    CHECK(boundary == random.boundary_segments.size());
    for (const std::int32_t p : first_ids<std::int32_t>(domain.points().size())) CHECK(domain.point_inside(p));
    for (const auto& s : random.input.segments) inner += s.marker >= 100, dangling += s.marker == 50;
    points += random.input.points.size() > random.input.segments.size();
  }
  CHECK(inner > 100);
  CHECK(dangling > 50);
  CHECK(points > 50);
}
