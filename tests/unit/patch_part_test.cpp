#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "adapt/descent.hpp"
#include "driftmesh/error.hpp"
#include "mesh/link_triangles.hpp"
#include "patch/part.hpp"
#include "support/random_mesh.hpp"
#include "unit_squares.hpp"

// The triangles of a finished mesh with their neighbors.

using namespace driftmesh;

namespace {

Mesh triangles(std::vector<Point> points, std::vector<std::array<std::int32_t, 3>> corners) {
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.triangles = std::move(corners);
  return mesh;
}

const std::vector<Point> kPoints{{0, 0}, {4, 0}, {2, 3}, {2, -3}, {2, -1}, {2, 1}};

}  // namespace

TEST_CASE("triangles of a mesh are linked as by their corners alone") {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Mesh mesh = test::RandomMesh(seed, 7, 6).mesh();
    const patch::Linked linked = patch::link(mesh);
    Triangulation again = linked.triangulation;
    for (Triangle& t : again.triangles) t.neighbor.fill(kNone);
    for (Subsegment& s : again.subsegments) s.half = {kNone, kNone};
    link_triangles(again);
    for (const TriangleId t : ids_of(again.triangles)) {
      CHECK(again.triangles[t].vertex == linked.triangulation.triangles[t].vertex);
      CHECK(again.triangles[t].neighbor == linked.triangulation.triangles[t].neighbor);
    }
    for (const SubsegmentId s : ids_of(again.subsegments))
      CHECK(again.subsegments[s].half == linked.triangulation.subsegments[s].half);
  }
}

TEST_CASE("triangles that do not fit together are refused") {
  using Corners = std::vector<std::array<std::int32_t, 3>>;
  const std::vector<std::pair<const char*, Corners>> bad{
      {"two on the same side of an edge", {{0, 1, 2}, {0, 1, 5}}},
      {"a third one at an edge", {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}}},
      {"a third one at an edge, before the others", {{1, 0, 4}, {0, 1, 2}, {1, 0, 3}}},
      {"the same twice", {{0, 1, 2}, {0, 1, 2}}},
      {"the same thrice", {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}},
      {"one that is turned around", {{0, 1, 2}, {0, 1, 3}}},
  };
  for (const auto& [what, corners] : bad) {
    CAPTURE(what);
    const Mesh mesh = triangles(kPoints, corners);
    CHECK_THROWS_WITH_AS((void)patch::triangulation_of(mesh, triangle_neighbors(mesh)),
                         "triangles do not fit together along their edges; look for the place with driftmesh check",
                         Error);
    CHECK_THROWS_AS((void)patch::link(mesh), Error);
  }
  CHECK(patch::link(triangles(kPoints, {{0, 1, 2}, {1, 0, 3}})).triangulation.roots.size() == 4);
}

TEST_CASE("all of a mesh is a part, unless it has points without triangles") {
  Mesh mesh = testing::unit_squares(3, 2);
  mesh.point_markers.assign(mesh.points.size(), 0);
  mesh.point_markers[4] = 7;
  mesh.regions.assign(mesh.triangles.size(), 2.5);
  mesh.edges = {{0, 1, 3}};
  patch::Linked linked = patch::link(mesh);
  const patch::Part some = patch::part_of(mesh, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const auto whole = patch::whole_part(mesh, linked);
  REQUIRE(whole);
  CHECK(whole->triangle == some.triangle);
  CHECK(whole->point == some.point);
  CHECK(whole->edge == some.edge);
  CHECK(whole->beyond == some.beyond);
  CHECK(whole->mesh.points == some.mesh.points);
  CHECK(whole->mesh.point_markers == some.mesh.point_markers);
  CHECK(whole->mesh.triangles == some.mesh.triangles);
  CHECK(whole->mesh.regions == some.mesh.regions);
  CHECK(whole->mesh.edges == some.mesh.edges);
  mesh.points.push_back({9, 9});
  mesh.point_markers.push_back(0);
  linked = patch::link(mesh);
  CHECK(!patch::whole_part(mesh, linked));
  CHECK(linked.beyond.size() == mesh.triangles.size());
}

TEST_CASE("triangles that meet in one point are found in another order") {
  const Mesh before = triangles({{0, 0}, {4, 0}, {4, 1}, {-4, 0}, {-4, -1}}, {{0, 1, 2}, {0, 3, 4}});
  const Mesh after = triangles({{-4, 0}, {-4, -1}, {4, 0}, {4, 1}, {0, 0}}, {{4, 2, 3}, {4, 0, 1}});
  const auto linked = [](const Mesh& mesh) { return patch::link(mesh).triangulation; };
  const adapt::Descent descent = adapt::trace(linked(before), linked(after));
  for (const TriangleId t : ids_of(descent.same)) CHECK(descent.same[t] == t);
}
