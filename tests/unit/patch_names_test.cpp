#include <doctest/doctest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "patch/new_outline.hpp"
#include "patch/old_places.hpp"
#include "patch/point_data.hpp"

// By what names, numbers and places a mesh is known while parts of it are made anew.

using namespace driftmesh;

TEST_CASE("a new name gets a number that neither the mesh nor the domain uses") {
  Mesh mesh;
  mesh.edges = {{0, 1, 1}, {1, 2, 4}};
  mesh.names.markers = {{1, "quay"}, {5, "sea"}};
  Pslg domain;
  domain.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 6}};
  domain.point_markers = {1, 3, 8, 0};
  domain.names.markers = {{1, "wall"}, {3, "sea"}, {6, "pier"}};
  patch::adopt_names(domain, mesh);
  // 1 is the quay, 4 and 5 are of the mesh, 2, 3 and 6 of the domain.
  CHECK(mesh.names.markers == std::map<std::int32_t, std::string>{{1, "quay"}, {5, "sea"}, {6, "pier"}, {7, "wall"}});
  std::vector<std::int32_t> markers;
  for (const Pslg::Segment& segment : domain.segments) markers.push_back(segment.marker);
  CHECK(markers == std::vector{7, 2, 5, 6});
  CHECK(domain.point_markers == std::vector{7, 5, 8, 0});
}

TEST_CASE("point data without names are called attributes, counted from 0 if there are several") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}};
  mesh.attributes_per_point = 2;
  mesh.attributes = {1, 2, 3, 4};
  const std::vector<patch::NamedField> two = patch::take_point_data(mesh);
  REQUIRE(two.size() == 2);
  CHECK(two[0].name == "attribute0");
  CHECK(two[0].field.values == std::vector{1.0, 3.0});
  CHECK(two[1].name == "attribute1");
  CHECK(two[1].field.values == std::vector{2.0, 4.0});
  CHECK(mesh.attributes.empty());
  mesh.attributes_per_point = 1;
  mesh.attributes = {5, 6};
  CHECK(patch::take_point_data(mesh).front().name == "attribute");
  mesh.attribute_names = {"depth"};
  mesh.attributes = {5, 6};
  CHECK(patch::take_point_data(mesh).front().name == "depth");
}

TEST_CASE("a point is found by its place, whatever the sign of zero") {
  Mesh mesh;
  mesh.points = {{0.0, -0.0}, {-0.0, 1.0}, {1.0, 0.0}, {1.0, 1.0}};
  mesh.triangles = {{0, 2, 1}};
  const patch::OldPlaces places(mesh);
  CHECK(places.point_at({0.0, 0.0}) == 0);
  CHECK(places.point_at({-0.0, -0.0}) == 0);
  CHECK(places.point_at({0.0, 1.0}) == 1);
  CHECK(places.point_at({1.0, -0.0}) == 2);
  CHECK(places.point_at({1.0, 0.5}) == -1);
  CHECK(places.triangle_of({1, 0, 2}) == 0);
  CHECK(places.triangle_of({0, 1, 3}) == -1);
}
