#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/adapt_part.hpp"
#include "driftmesh/error.hpp"
#include "patch/flaws.hpp"
#include "patch/part.hpp"
#include "patch/remake.hpp"
#include "support/error_text.hpp"
#include "unit_squares.hpp"

// Meshes of which nothing can be made, and what is said about them.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using AnyTriangles = std::vector<std::array<std::int32_t, 3>>;

Mesh as_mesh(std::vector<Point> points, AnyTriangles corners) {
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.triangles = std::move(corners);
  return mesh;
}

/// Makes all of it anew.
void remake_all(const Mesh& mesh) {
  patch::Order order{.inside = std::vector<bool>(mesh.triangles.size(), true)};
  (void)patch::remake(mesh, {}, order);
}

const std::vector<Point> kSevenPoints{{0, 0}, {4, 0}, {2, 3}, {2, -3}, {2, -1}, {2, 1}, {2, 0}};

}  // namespace

TEST_CASE("a mesh whose arrays do not belong together is refused, whoever gets it") {
  const std::vector<std::pair<std::string, std::function<void(Mesh&)>>> bad{
      {"triangle 3 (1 1 2; counted from 0): three different points below 20",
       [](Mesh& m) {
         m.triangles[3] = {1, 1, 2};
       }},
      {"triangle 3 (1 2 1; counted",
       [](Mesh& m) {
         m.triangles[3] = {1, 2, 1};
       }},
      {"triangle 3 (2 1 1; counted",
       [](Mesh& m) {
         m.triangles[3] = {2, 1, 1};
       }},
      {"triangle 5 (7 7 7; counted",
       [](Mesh& m) {
         m.triangles[5] = {7, 7, 7};
       }},
      {"triangle 0 (0 1 20; counted",
       [](Mesh& m) {
         m.triangles[0] = {0, 1, 20};
       }},
      {"triangle 0 (0 -1 2; counted",
       [](Mesh& m) {
         m.triangles[0] = {0, -1, 2};
       }},
      {"edge 1 (0 20; counted from 0): two different points below 20",
       [](Mesh& m) {
         m.edges = {{0, 1, 1}, {0, 20, 1}};
       }},
      {"edge 0 (-3 0;",
       [](Mesh& m) {
         m.edges = {{-3, 0, 1}};
       }},
      {"edge 0 (3 3;",
       [](Mesh& m) {
         m.edges = {{3, 3, 1}};
       }},
      {"point 7 (inf, 1; counted", [](Mesh& m) { m.points[7].x = std::numeric_limits<double>::infinity(); }},
      {"point 7 (2, nan; counted", [](Mesh& m) { m.points[7].y = std::numeric_limits<double>::quiet_NaN(); }},
      {"3 point markers where 20",
       [](Mesh& m) {
         m.point_markers = {0, 0, 0};
       }},
      {"1 regions where 24", [](Mesh& m) { m.regions = {1}; }},
      {"25 subdomains where 24", [](Mesh& m) { m.subdomains.assign(25, 0); }},
      {"a weir names a point",
       [](Mesh& m) { m.weirs.push_back({.type = 3, .points = {20}, .across = {}, .values = {}}); }},
      {"a weir names a point",
       [](Mesh& m) { m.weirs.push_back({.type = 4, .points = {1}, .across = {-1}, .values = {}}); }},
      {"no triangles", [](Mesh& m) { m.triangles.clear(); }},
      {"no triangles", [](Mesh& m) { m = {}; }},
  };
  for (const auto& [says, spoil] : bad) {
    CAPTURE(says);
    Mesh mesh = unit_squares(4, 3);
    spoil(mesh);
    CHECK(mentions(error_text([&] { (void)patch::link(mesh); }), says));
    CHECK(mentions(error_text([&] { remake_all(mesh); }), says));
    CHECK(mentions(error_text([&] { (void)adapt_part(mesh, {}); }), says));
    Pslg square;
    square.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
    square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
    CHECK(mentions(error_text([&] { (void)adapt_outline(mesh, square); }), says));
  }
}

TEST_CASE("attributes are as many as the points have") {
  Mesh mesh = unit_squares(2, 2);
  mesh.attributes_per_point = 2;
  mesh.attributes.assign(17, 0);
  CHECK(mentions(error_text([&] { (void)adapt_part(mesh, {}); }), "17 values of attributes for 9 points; 18"));
  mesh.attributes.push_back(0);
  mesh.attribute_names = {"u"};
  CHECK(mentions(error_text([&] { (void)adapt_part(mesh, {}); }), "1 names of attributes for 2"));
  mesh.attribute_names.emplace_back("v");
  CHECK(adapt_part(mesh, {}).mesh.attributes == mesh.attributes);
}

TEST_CASE("where triangles do not fit together is said in numbers of the mesh") {
  const std::vector<std::pair<std::string, AnyTriangles>> bad{
      {"triangles 0 and 1 (counted from 0) lie on the same side of the edge from point 0 (0, 0) to point 1 (4, 0)",
       {{0, 1, 2}, {0, 1, 5}}},
      {"triangles 1 and 2 (counted from 0) lie on the same side of the edge from point 1 (4, 0) to point 0 (0, 0)",
       {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}}},
      {"triangles 0 and 1 (counted from 0) have the same corners", {{0, 1, 2}, {1, 2, 0}}},
      {"triangles 1 and 3 (counted from 0) have the same corners", {{1, 0, 3}, {0, 1, 2}, {4, 3, 1}, {2, 0, 1}}},
      {"corners of 1 of 2 triangles run in the other direction than those of the others, first those of triangle 1",
       {{0, 1, 2}, {0, 1, 3}}},
      {"all triangles are clockwise", {{1, 0, 2}, {0, 1, 3}}},
      {"triangle 1 (0 6 1; counted from 0) is flat", {{0, 1, 2}, {0, 6, 1}}},
      {"point 6 (2, 0) lies on the edge from point 0 (0, 0) to point 1 (4, 0), which triangle 0 has as a whole",
       {{0, 1, 2}, {0, 3, 6}, {6, 3, 1}}},
  };
  for (const auto& [says, corners] : bad) {
    CAPTURE(says);
    const Mesh mesh = as_mesh(kSevenPoints, corners);
    CHECK(patch::find_flaw(mesh).find(says) == 0);
    CHECK(error_text([&] { remake_all(mesh); }) == patch::find_flaw(mesh) + "; driftmesh check lists all such places");
  }
}

TEST_CASE("points in one place and crossing edges are flaws") {
  const Mesh twice = as_mesh({{0, 0}, {4, 0}, {2, 3}, {4, 0}, {9, 9}, {2, -3}, {9, 9}}, {{0, 1, 2}, {0, 5, 3}});
  CHECK(patch::find_flaw(twice).find("points 1 and 3 (counted from 0) are both at (4, 0)") == 0);
  CHECK(error_text([&] { remake_all(twice); }) == patch::find_flaw(twice) + "; driftmesh check lists all such places");
  const Mesh crossing = as_mesh({{0, 0}, {4, 0}, {0, 4}, {1, 1}, {5, 1}, {1, 5}}, {{0, 1, 2}, {3, 4, 5}});
  CHECK(patch::find_flaw(crossing).find("the edge from point 1 (4, 0) to point 2 (0, 4) crosses that from point") == 0);
  CHECK(mentions(error_text([&] { remake_all(crossing); }), "so that triangles overlap; driftmesh check"));
}

TEST_CASE("a mesh without flaws has none") {
  Mesh mesh = unit_squares(5, 4);
  CHECK(patch::find_flaw(mesh).empty());
  mesh.points.push_back(mesh.points[3]);  // in no triangle
  CHECK(patch::find_flaw(mesh).empty());
  CHECK(error_text([&] { patch::with_flaw_of(mesh, [] { throw Error("something else"); }); }) == "something else");
  CHECK(patch::with_flaw_of(mesh, [] { return 7; }) == 7);
  mesh.triangles[0] = {0, 6, 0};
  CHECK(error_text([&] { patch::with_flaw_of(mesh, [] { throw LimitError("enough"); }); }) == "enough");
  // Triangles that meet at a corner.
  CHECK(patch::find_flaw(as_mesh({{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}, {{0, 1, 2}, {0, 3, 4}})).empty());
}
