#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "verify/stayed.hpp"

// What stayed of a mesh, where one thing after the other has changed.

using namespace driftmesh;

namespace {

/// Two by one squares, each of two triangles, with a marked line between them.
Mesh strip() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  mesh.edges = {{0, 1, 1}, {1, 2, 1}, {2, 5, 2}, {5, 4, 3}, {4, 3, 3}, {3, 0, 4}, {1, 4, 7}};
  mesh.point_markers = {1, 1, 1, 3, 3, 3};
  mesh.regions = {5, 5, 6, 6};
  mesh.attributes_per_point = 2;
  mesh.attribute_names = {"depth", "drag"};
  for (int v = 0; v < 6; ++v) mesh.attributes.insert(mesh.attributes.end(), {10.0 + v, 0.5 * v});
  return mesh;
}

/// The strip with the second square cut along its other diagonal.
Mesh flipped() {
  Mesh mesh = strip();
  mesh.triangles[2] = {1, 2, 4};
  mesh.triangles[3] = {2, 5, 4};
  return mesh;
}

StayedReport compared(const Mesh& now, const std::optional<NumberMap>& map = {}, const Mesh& before = strip()) {
  return compare_stayed(before, now, map, 3);
}

/// What contradicts, if it is one thing.
std::string contradiction(const Mesh& now, const std::optional<NumberMap>& map = {}, const Mesh& before = strip()) {
  const StayedReport report = compared(now, map, before);
  if (report.contradictions == 0) return "nothing";
  return report.contradictions == 1 ? report.examples.at(0) : "several: " + report.examples.at(0);
}

template <class Change>
std::string after(const Change& change) {
  Mesh mesh = strip();
  change(mesh);
  return contradiction(mesh);
}

const NumberMap kFlip{.points = {}, .triangles = {{2, -1}, {3, -1}}};

}  // namespace

TEST_CASE("all of a mesh has stayed in itself") {
  for (const bool mapped : {false, true}) {
    const StayedReport report = compared(strip(), mapped ? std::optional(NumberMap{}) : std::nullopt);
    CHECK(report.contradictions == 0);
    for (const auto& [count, all] : {std::pair(report.points, 6), std::pair(report.triangles, 4)}) {
      CHECK(count.stayed == all);
      CHECK(count.numbered == all);
      CHECK(count.made == 0);
      CHECK(count.gone == 0);
    }
    CHECK(report.edges == 8);  // that between the squares from both sides
    CHECK(report.near_changes == 0);
    CHECK(report.data == std::vector<std::string>{"depth", "drag"});
  }
}

TEST_CASE("what was made anew is told from what stayed, with a map or without") {
  Mesh now = flipped();
  now.attributes[2 * 5] = 99;  // depth of a point none of whose triangles stayed
  now.point_markers[5] = 8;
  for (const bool mapped : {false, true}) {
    const StayedReport report = compared(now, mapped ? std::optional(kFlip) : std::nullopt);
    CHECK_MESSAGE(report.contradictions == 0, stayed_text(report, mapped));
    CHECK(report.points.stayed == 6);
    CHECK(report.triangles.stayed == 2);
    CHECK(report.triangles.numbered == 2);
    CHECK(report.triangles.made == 2);
    CHECK(report.triangles.gone == 2);
    CHECK(report.edges == 4);
    CHECK(report.near_changes == 1);
  }
  Mesh less = strip();
  less.triangles.pop_back();
  const StayedReport report = compared(less);
  CHECK(report.triangles.stayed == 3);
  CHECK(report.triangles.made == 0);
  CHECK(report.triangles.gone == 1);
}

TEST_CASE("numbers that have changed are counted apart") {
  Mesh now = strip();
  std::swap(now.triangles[0], now.triangles[1]);
  const StayedReport report = compared(now);
  CHECK(report.triangles.stayed == 4);
  CHECK(report.triangles.numbered == 2);
  const NumberMap map{.points = {}, .triangles = {{0, 1}, {1, 0}}};
  CHECK(contradiction(now, map) == "nothing");
  CHECK(compared(now, NumberMap{}).contradictions == 2);
}

TEST_CASE("of several points at one place each is one, and a turned triangle is another") {
  Mesh twice = strip();
  twice.points.push_back({0, 0});
  twice.point_markers.push_back(1);
  twice.attributes.insert(twice.attributes.end(), {10, 0});
  const StayedReport report = compared(twice);
  CHECK(report.points.stayed == 6);
  CHECK(report.points.made == 1);
  CHECK(compared(twice, {}, twice).points.numbered == 7);
  Mesh turned = strip();
  turned.triangles[0] = {1, 4, 0};
  CHECK(compared(turned).triangles.stayed == 3);
  CHECK(contradiction(turned, NumberMap{}) == "triangle 0 has not the corners that triangle 0 of the old mesh had");
}

TEST_CASE("what changed where nothing was made anew contradicts") {
  CHECK(after([](Mesh& m) { m.regions[1] = 9; }) == "triangle 1 was in region 5 and is in 9");
  CHECK(after([](Mesh& m) { m.point_markers[2] = 9; }) == "point 2 had marker 1 and has 9");
  CHECK(after([](Mesh& m) { m.edges[5].marker = 9; }) == "the edge from point 3 to point 0 had marker 4 and has 9");
  CHECK(after([](Mesh& m) { m.edges.erase(m.edges.begin() + 5); }) ==
        "the edge from point 3 to point 0 is no longer listed");
  CHECK(after([](Mesh& m) { m.attributes[2 * 3 + 1] = 7; }) == "'drag' at point 3 was 1.5 and is 7");
  CHECK(after([](Mesh& m) { m.edges.push_back({0, 4, 3}); }) == "nothing");  // a new line
}

TEST_CASE("a map that is wrong is named") {
  using Entries = std::vector<NumberMap::Entry>;
  const auto with_points = [](Entries points) { return contradiction(strip(), NumberMap{std::move(points), {}}); };
  const auto with_triangles = [](const Mesh& now, Entries triangles) {
    return contradiction(now, NumberMap{{}, std::move(triangles)});
  };
  CHECK(with_points({{6, 0}}) == "the map lists point 6, which the new mesh has not");
  CHECK(with_points({{-1, 0}}) == "the map lists point -1, which the new mesh has not");
  CHECK(with_points({{0, 6}}) == "the map gives point 0 the old number 6, which the old mesh has not");
  CHECK(with_points({{0, 0}, {0, 0}}) == "the map lists point 0 twice");
  CHECK(with_points({{0, -1}}).find("several: point 0 is new by the map, but is where point 0") == 0);
  CHECK(with_triangles(strip(), {{3, -1}}) ==
        "triangle 3 is new by the map, but has the corners of triangle 3 of the old mesh");
  Mesh elsewhere = strip();
  elsewhere.regions[3] = 9;
  CHECK(with_triangles(elsewhere, {{3, -1}}) == "nothing");
  CHECK(with_triangles(flipped(), {{2, -1}}) == "triangle 3 has not the corners that triangle 3 of the old mesh had");
  CHECK(with_triangles(strip(), {{3, 2}}).find("triangle 3 has the old number 2, which another one has, too") !=
        std::string::npos);
  Mesh moved = strip();
  moved.points[3].y = 1.5;
  CHECK(contradiction(moved, NumberMap{}).find("point 3 is not where point 3 of the old mesh was") !=
        std::string::npos);
  Mesh more = strip();
  more.points.push_back({3, 3});
  more.point_markers.push_back(0);
  more.attributes.insert(more.attributes.end(), {0, 0});
  CHECK(contradiction(more, NumberMap{}) == "point 6 is not in the map, but the old mesh has no such number");
}

TEST_CASE("data that only one of both has is named, and no more examples than asked for") {
  Mesh now = strip();
  now.attribute_names = {"depth", "speed"};
  const StayedReport report = compared(now);
  CHECK(report.data == std::vector<std::string>{"depth"});
  CHECK(report.only_in_old == std::vector<std::string>{"drag"});
  CHECK(report.only_in_new == std::vector<std::string>{"speed"});
  Mesh turned = strip();  // its data in the other order
  std::ranges::swap(turned.attribute_names[0], turned.attribute_names[1]);
  for (std::size_t v = 0; v < 6; ++v) std::swap(turned.attributes[2 * v], turned.attributes[2 * v + 1]);
  CHECK(contradiction(turned) == "nothing");
  for (std::int32_t& marker : now.point_markers) marker = 9;
  const StayedReport many = compared(now);
  CHECK(many.contradictions == 6);
  CHECK(many.examples.size() == 3);
}
