#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "oracles/random_polygons.hpp"
#include "support/grid_polygons.hpp"
#include "verify/cut_rings.hpp"
#include "verify/domain.hpp"
#include "verify/polygons_check.hpp"
#include "verify/verify.hpp"

// How the verifier reads polygons, against the exact areas of an oracle.

using namespace driftmesh;
using namespace driftmesh::oracles;
using driftmesh::testing::raw_rings;

namespace {

Pslg given(const std::vector<GridPolygon>& polygons) {
  return raw_rings(RandomPolygons{polygons, {}, 1});
}

Domain domain_of(const Pslg& input, const std::vector<Point>& places = {}) {
  std::optional<Pslg> rings = rings_alone(input);
  REQUIRE(rings);
  if (Domain(*rings).conflict()) rings = cut_rings(*rings);
  REQUIRE(rings);
  Domain domain(*rings, HoleRule::kPoints, places);
  INFO(domain.conflict().value_or(""));
  REQUIRE(!domain.conflict());
  return domain;
}

/// A square in [0, 2]^2 and its right half in another region: points, and two or four triangles.
Mesh halves() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}};
  mesh.regions = {1, 1, 2, 2};
  mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}, {5, 0, 0}, {1, 4, 0}};
  return mesh;
}

/// The same as two polygons, planar.
Pslg halves_as_polygons() {
  Pslg pslg;
  pslg.points = halves().points;
  for (const Mesh::Edge& edge : halves().edges) pslg.segments.push_back({edge.a, edge.b, 0});
  pslg.regions = {{{}, 1, 0}, {{}, 2, 0}};
  pslg.polygons = {{{{0, 1, 4, 5}}, 0, 1}, {{{1, 2, 3, 4}}, 1, 2}};
  return pslg;
}

VerifyReport check(const Mesh& mesh, const Pslg& input, const Pslg& as_given) {
  return verify(mesh, input, {.given = &as_given});
}

}  // namespace

TEST_CASE("areas of random polygons and of their regions are those of the oracle") {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const RandomPolygons set = make_random_polygons(seed);
    const PolygonAreas expected = covered_areas(set.polygons);
    const Domain domain = domain_of(raw_rings(set));
    const double square = set.unit * set.unit, tolerance = domain.border_tolerance() + 1e-12 * domain.area();
    CAPTURE(seed);
    CHECK(std::fabs(domain.area() - static_cast<double>(expected.total) * square) <= tolerance);
    auto areas = domain.areas_of_regions();
    for (const auto& [region, area] : expected.regions)
      CHECK(std::fabs(areas[region] - static_cast<double>(area) * square) <= tolerance);
  }
}

TEST_CASE("places are found in polygons and their holes") {
  const Pslg input = given(
      {{{rectangle(0, 0, 10, 10), rectangle(2, 2, 6, 6), rectangle(4, 4, 8, 8)}, 1}, {{rectangle(5, 5, 20, 20)}, {}}});
  const Domain domain = domain_of(input, {{1, 1}, {3, 3}, {7, 5.5}, {15, 15}, {4.5, 4.5}, {30, 1}, {9, 9}});
  const std::vector<bool> inside{true, false, true, true, false, false, true};
  for (std::size_t i = 0; i < inside.size(); ++i) {
    CAPTURE(i);
    CHECK(domain.inside(domain.face_of_place(i)) == inside[i]);
  }
  CHECK(domain.region_of(domain.face_of_place(6))->attribute == 1);  // the other has none
  CHECK(domain.region_of(domain.face_of_place(3)) == nullptr);
}

TEST_CASE("a mesh of polygons is judged by them") {
  const Pslg input = halves_as_polygons();
  CHECK(verify(halves(), input, {}).accepted());
  CHECK(check(halves(), input, input).accepted());
  Mesh mesh = halves();
  mesh.regions[2] = 1;
  CHECK(verify(mesh, input, {}).findings.count(Flaw::kWrongRegion) == 1);
  Pslg other = input;
  other.polygons[1].rings.push_back({1, 3, 4});                                   // a hole
  CHECK(verify(halves(), other, {}).findings.count(Flaw::kInputNotPlanar) == 1);  // without a segment
  other.polygons.pop_back();
  CHECK(!verify(halves(), other, {}).accepted());
}

TEST_CASE("a mesh has no regions where those of the polygons are all taken away") {
  Pslg input = halves_as_polygons();
  for (const std::size_t k : {0, 1}) {
    Pslg::Polygon& polygon = input.polygons[k];
    Pslg::Polygon bare = polygon;
    polygon.rings.push_back(polygon.rings[0]);  // a hole that takes all
    bare.region = -1;
    input.polygons.push_back(std::move(bare));
  }
  CHECK(verify(halves(), input, {}).findings.count(Flaw::kWrongRegion) == 4);
  Mesh mesh = halves();
  mesh.regions.assign(4, 0);
  CHECK(verify(mesh, input, {}).accepted());
}

TEST_CASE("what repair made of polygons is judged by the polygons as they were given") {
  const Pslg input = halves_as_polygons();
  Pslg raw = given({{{rectangle(0, 0, 2, 2)}, 1}, {{rectangle(1, 0, 2, 2)}, 2}});
  CHECK(!same_polygons(raw, input));  // repair cuts sides in halves
  VerifyReport report = check(halves(), input, raw);
  CHECK(report.accepted());
  CHECK(report.polygons_judged);

  raw = given({{{rectangle(1, 0, 2, 2)}, 2}, {{rectangle(0, 0, 2, 2)}, 1}});  // the last counts
  report = check(halves(), input, raw);
  CHECK(report.findings.total() == report.findings.count(Flaw::kWrongPolygons));
  CHECK(report.findings.count(Flaw::kWrongPolygons) == 3);
  CHECK(report.findings.messages(Flaw::kWrongPolygons)[0] ==
        "the face of area 2 around (1.6666666666666665, 0.6666666666666666) belongs to region 2, by the polygons of "
        "the input to 1");
  CHECK(report.findings.messages(Flaw::kWrongPolygons)[1].starts_with(
      "the area of region 1 is 2, by the polygons of the input 4 (rounding explains "));

  raw = given({{{rectangle(0, 0, 1, 2)}, 1}, {{rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)}, 2}});  // no right half
  report = check(halves(), input, raw);
  CHECK(report.findings.messages(Flaw::kWrongPolygons)[0].ends_with(") lies in no polygon of the input"));

  raw = given({{{rectangle(0, 0, 2, 2)}, 1}, {{rectangle(1, 0, 2, 3)}, 2}});  // more than is meshed
  report = check(halves(), input, raw);
  CHECK(report.findings.messages(Flaw::kWrongPolygons)[0].starts_with("the area of the domain is 4, by"));
}

TEST_CASE("polygons that were snapped or simplified are judged by areas, within what that explains") {
  const Pslg input = halves_as_polygons();
  const auto wrong = [&](const Pslg& raw, double moved) {
    const VerifyReport report = verify(halves(), input, {.given = &raw, .moved = moved});
    CHECK(report.findings.total() == report.findings.count(Flaw::kWrongPolygons));
    return report.findings.count(Flaw::kWrongPolygons);
  };
  Pslg raw =
      raw_rings(RandomPolygons{{{{rectangle(0, 0, 100, 201)}, 1}, {{rectangle(100, 0, 200, 200)}, 2}}, {}, 0.01});
  CHECK(wrong(raw, 0) == 2);  // the domain and region 1
  CHECK(wrong(raw, 0.01) == 0);
  raw = raw_rings(RandomPolygons{{{{rectangle(0, 0, 200, 200)}, 1}}, {}, 0.01});  // region 2 is missing
  CHECK(wrong(raw, 0.01) == 2);
  raw = raw_rings(RandomPolygons{{{{rectangle(0, 0, 100, 200)}, 1}, {{rectangle(100, 0, 200, 200)}, 3}}, {}, 0.01});
  CHECK(wrong(raw, 0.01) == 2);  // the one has no region 2, the other no region 3
}

TEST_CASE("a mesh is judged by the verifier's own holes between nested rings") {
  Pslg input = halves_as_polygons();
  input.polygons.clear();
  input.regions.clear();
  Mesh mesh = halves();
  mesh.regions.clear();
  CHECK(
      verify(mesh, input, {.holes = HoleRule::kNested}).accepted());  // the halves share a segment, and so are one ring
  input.points.insert(input.points.end(), {{1.25, 0.25}, {1.75, 0.25}, {1.75, 0.75}});
  for (const std::int32_t a : {6, 7, 8}) input.segments.push_back({a, a < 8 ? a + 1 : 6, 0});
  CHECK(Domain(input).area() == 4);
  CHECK(Domain(input, HoleRule::kNested).area() == 3.875);
  const VerifyReport report = verify(mesh, input, {.holes = HoleRule::kNested});
  CHECK(report.input_area == 3.875);
  CHECK(!report.accepted());
}

TEST_CASE("points in the same place make no other polygons") {
  const Pslg input = halves_as_polygons();
  const Pslg raw = given({{{rectangle(0, 0, 1, 2)}, 1}, {{rectangle(1, 0, 2, 2)}, 2}});
  CHECK(same_polygons(raw, input));
  CHECK(same_polygons(input, input));
  Pslg other = raw;
  other.points[5].x = 1.5;
  CHECK(!same_polygons(other, input));
  other = raw;
  std::swap(other.polygons[0], other.polygons[1]);
  CHECK(!same_polygons(other, input));
}

TEST_CASE("corners that repeat the one before them make no other polygons") {
  const Pslg input = halves_as_polygons();
  Pslg repeated = input;
  repeated.polygons[0].rings[0] = {0, 0, 1, 4, 4, 4, 5, 0};
  CHECK(same_polygons(repeated, input));
  const std::optional<Pslg> rings = rings_alone(repeated);
  REQUIRE(rings);
  CHECK(rings->segments.size() == 7);
  repeated.points.push_back(input.points[3]);  // the same by another number
  repeated.polygons[1].rings[0] = {1, 2, 3, 6, 4};
  CHECK(same_polygons(repeated, input));
  repeated.polygons[1].rings[0] = {1, 2, 3, 5, 4};
  CHECK(!same_polygons(repeated, input));
}

TEST_CASE("an unknown point, place or region of polygons is no crash") {
  Pslg input = halves_as_polygons();
  input.polygons[0].rings[0][2] = 77;
  CHECK(!verify(halves(), input, {}).accepted());
  CHECK(!rings_alone(input));
  input = halves_as_polygons();
  input.polygons[0].region = 5;
  CHECK(!verify(halves(), input, {}).accepted());
  input = halves_as_polygons();
  input.polygons[0].rings = {{}, {}};
  input.polygons.push_back({});
  CHECK(!verify(halves(), input, {}).accepted());
  input.points[0].x = std::nan("");
  CHECK(!rings_alone(input));
}
