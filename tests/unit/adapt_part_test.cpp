#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "support/error_text.hpp"

// Parts of finished meshes that are made anew, other outlines of them, and old meshes of adaptive ones.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Pslg port(double corner) {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 2}, {corner, 3}, {0, 3}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 4, 4}, {4, 0, 5}};
  return pslg;
}

/// How many triangles have their numbers, and corners, by old numbers.
std::ptrdiff_t stayed(const Mesh& before, const AdaptedMesh& after) {
  std::ptrdiff_t count = 0;
  for (std::size_t t = 0; t < after.old_triangles.size(); ++t) {
    const std::int32_t old = after.old_triangles[t];
    if (old < 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(after.mesh.triangles[t][i]);
      const std::int32_t old_corner = before.triangles[static_cast<std::size_t>(old)][i];
      CHECK(after.old_points[v] == old_corner);
      CHECK(after.mesh.points[v] == before.points[static_cast<std::size_t>(old_corner)]);
    }
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("another outline leaves what it does not concern, and back again") {
  const Mesh before = mesh(port(3), {.max_area = 0.005});
  const AdaptedMesh after = adapt_outline(before, port(3.5));
  CHECK(check(after.mesh, port(3.5)).accepted);
  CHECK(2 * stayed(before, after) > std::ssize(before.triangles));
  CHECK(after.beyond > 0);
  const AdaptedMesh again = adapt_outline(after.mesh, port(3));
  CHECK(check(again.mesh, port(3)).accepted);
  CHECK(again.beyond == 0);
  const AdaptedMesh same = adapt_outline(before, port(3));
  CHECK(same.mesh.points == before.points);
  CHECK(same.mesh.triangles == before.triangles);
  CHECK(same.mesh.edges == before.edges);
}

TEST_CASE("markers are numbered by their names where an outline has others") {
  Pslg named = port(3);
  named.names.markers = {{1, "quay"}, {2, "sea"}};
  const Mesh before = mesh(named, {.max_area = 0.02});
  Pslg next = port(3.5);
  for (Pslg::Segment& segment : next.segments) segment.marker = segment.marker == 3 ? 1 : 7;
  next.names.markers = {{1, "wall"}, {7, "sea"}};
  const AdaptedMesh after = adapt_outline(before, next);
  // What is new is wall, whose number is in use, and what was at 4 to 0 is there already.
  std::int32_t wall = 0;
  for (const auto& [marker, name] : after.mesh.names.markers)
    if (name == "wall") wall = marker;
  CHECK(wall > 5);
  CHECK(after.mesh.names.markers.at(1) == "quay");
  CHECK(after.mesh.names.markers.at(2) == "sea");
  CHECK(after.mesh.names.markers.size() == 3);
  for (const Mesh::Edge& edge : after.mesh.edges) {
    const Point &a = after.mesh.points[static_cast<std::size_t>(edge.a)],
                &b = after.mesh.points[static_cast<std::size_t>(edge.b)];
    CHECK((edge.marker == wall) == (a.x + b.x > 7 && a.y + b.y > 4));
    CHECK((edge.marker == 2) == ((a.x == 4 && b.x == 4) || (a.y == 3 && b.y == 3 && a.x + b.x > 6)));
  }
}

TEST_CASE("a part, with lengths and point data") {
  Mesh before = mesh(port(3), {.max_area = 0.01});
  before.attributes_per_point = 1;
  before.attribute_names = {"depth"};
  before.attributes.clear();
  for (const Point& p : before.points) before.attributes.push_back(2 * p.x - p.y);
  std::vector<std::int32_t> part;
  for (std::size_t t = 0; t < before.triangles.size(); ++t)
    if (before.points[static_cast<std::size_t>(before.triangles[t][0])].x < 1)
      part.push_back(static_cast<std::int32_t>(t));
  PartOptions options{.sizes = {.longest = 0.05}};
  const AdaptedMesh after = adapt_part(before, part, options);
  CHECK(check(after.mesh, port(3)).accepted);
  CHECK(stayed(before, after) > 0);
  for (std::size_t v = 0; v < after.mesh.points.size(); ++v)
    CHECK(after.mesh.attributes[v] ==
          doctest::Approx(2 * after.mesh.points[v].x - after.mesh.points[v].y).epsilon(1e-12));
  options.conserve = {"depth"};
  CHECK(adapt_part(before, part, options).mesh.triangles == after.mesh.triangles);
  for (const double wrong : {std::nan(""), -std::numeric_limits<double>::infinity(), 1e300}) {
    Mesh damaged = before;
    damaged.attributes[7] = wrong;
    CHECK(mentions(error_text([&] { (void)adapt_part(damaged, part, options); }), {"'depth' is", "at point 7"}));
  }
  const std::string refused = error_text([&] { (void)adapt_outline(before, port(3.5), options); });
  CHECK(mentions(refused, {"the integral of 'depth' cannot stay", "interpolate"}));
  options.conserve = {"heat"};
  CHECK(error_text([&] { (void)adapt_part(before, part, options); }).find("'heat'") != std::string::npos);
  CHECK(error_text([&] { (void)adapt_part(before, std::vector{-1}); }).find("no triangle -1") != std::string::npos);
  std::vector<double> lengths(before.points.size(), 1);
  lengths[3] = -1e-9;
  CHECK(mentions(error_text([&] { (void)adapt_part(before, part, {.lengths = lengths}); }),
                 "the length at point 3 (counted from 0) is -1e-09;"));
  CHECK(mentions(error_text([&] { (void)adapt_part(before, part, {.tolerance = -1e-9}); }),
                 "PartOptions::tolerance is -1e-09; it must be at least 0"));
  CHECK(mentions(error_text([&] { (void)adapt_part(before, part, {.sizes = {.shortest = 2, .longest = 1}}); }),
                 {"PartOptions::sizes.longest is 1; it must be", "not below PartOptions::sizes.shortest, which is 2"}));
}

TEST_CASE("a weir stays where it is, or is an error") {
  Mesh before = mesh(port(3), {.max_area = 0.05});
  std::int32_t corner = -1;
  for (std::size_t v = 0; v < before.points.size(); ++v)
    if (before.points[v] == Point{3, 3}) corner = static_cast<std::int32_t>(v);
  before.weirs.push_back({.type = 3, .points = {corner}, .across = {}, .values = {1, 1}});
  CHECK(error_text([&] { (void)adapt_outline(before, port(3.5)); }).find("weir") != std::string::npos);
  CHECK(adapt_outline(before, port(3)).mesh.weirs == before.weirs);
}

TEST_CASE("a tolerance that takes two lines for one is an error") {
  Pslg pier = port(3);
  pier.points.insert(pier.points.end(), {{1, 1}, {2, 1}, {1, 1.05}, {2, 1.05}});
  pier.segments.insert(pier.segments.end(), {{5, 6, 6}, {7, 8, 6}});
  const Mesh before = mesh(pier, {.max_area = 0.05});
  Pslg line = port(3);
  line.points.insert(line.points.end(), {{1, 1.02}, {2, 1.02}});
  line.segments.push_back({5, 6, 6});
  const AdaptedMesh after = adapt_outline(before, line);
  CHECK(check(after.mesh, line).accepted);
  CHECK(error_text([&] { (void)adapt_outline(before, line, {.tolerance = 0.04}); }).find("smaller tolerance") !=
        std::string::npos);
}

TEST_CASE("marked points where nobody lists a line make way for one") {
  Pslg wall = port(3);
  wall.points.insert(wall.points.end(), {{0.5, 1}, {3.5, 1}});
  wall.segments.push_back({5, 6, 6});
  Mesh before = mesh(wall, {.max_area = 0.05});
  std::erase_if(before.edges, [](const Mesh::Edge& edge) { return edge.marker == 6; });
  before.point_markers.resize(before.points.size(), 0);
  std::ptrdiff_t marked = 0;
  for (std::size_t v = 0; v < before.points.size(); ++v)
    if (before.points[v].y == 1 && before.points[v].x > 0.4 && before.points[v].x < 3.6)
      before.point_markers[v] = 6, ++marked;
  CHECK(marked > 4);
  CHECK(check(adapt_outline(before, wall).mesh, wall).accepted);
}

TEST_CASE("an old mesh is kept on request") {
  AdaptiveMesh adaptive(port(3), {.max_area = 0.02, .threads = 1});
  const auto refine = [&](double length) {
    adaptive.adapt(std::vector<double>(adaptive.mesh().points.size(), length));
  };
  refine(0.15);
  CHECK(error_text([&] { (void)adaptive.old_mesh(); }).find("keep_old") != std::string::npos);
  adaptive.keep_old();
  const Mesh before = adaptive.mesh();
  refine(0.1);
  CHECK(adaptive.old_mesh().points == before.points);
  CHECK(adaptive.old_mesh().triangles == before.triangles);
  adaptive.keep_old(false);
  CHECK(error_text([&] { (void)adaptive.old_mesh(); }).find("keep_old") != std::string::npos);
}

TEST_CASE("what is forecast of a generation is what it makes, not what it keeps") {
  std::vector<double> forecasts;
  MeshOptions options{.max_area = 0.001, .subdomains = {.count = 12}};
  options.progress = [&](const Progress& progress) {
    forecasts.push_back(progress.forecast);
    return true;
  };
  AdaptiveMesh session(port(3), options, {.gradation = 0});
  const auto before = static_cast<double>(session.mesh().triangles.size());
  const auto forecast_for = [&](double finest) {  // within 0.05 of the corner; 0.01 around that
    std::vector<double> lengths;
    for (const Point& p : session.mesh().points)
      lengths.push_back(p.x + p.y < 0.05 ? finest : p.x + p.y < 0.3 ? 0.01 : 0.08);
    forecasts.clear();
    session.adapt(lengths);
    REQUIRE(!forecasts.empty());
    return *std::ranges::max_element(forecasts);
  };
  const double made = forecast_for(0.01);
  CHECK(made < before / 2);
  CHECK(static_cast<double>(session.mesh().triangles.size()) > before);
  CHECK(forecast_for(0.008) < made / 2);  // mended
}
