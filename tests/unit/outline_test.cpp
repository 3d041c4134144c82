#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "geometry/triangle_geometry.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

void add_ring(Pslg& pslg, const std::vector<Point>& ring, const std::vector<std::int32_t>& markers) {
  const auto first = static_cast<std::int32_t>(pslg.points.size()), count = static_cast<std::int32_t>(ring.size());
  pslg.points.insert(pslg.points.end(), ring.begin(), ring.end());
  for (std::int32_t i = 0; i < count; ++i)
    pslg.segments.push_back(
        {first + i, first + (i + 1) % count, markers[static_cast<std::size_t>(i) % markers.size()]});
}

/// Two regions beside each other, a hole in each, one with an island in it and one that touches the border, and a line.
Pslg lagoon() {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {5, 0}, {10, 0}, {10, 6}, {5, 6}, {0, 6}}, {1, 1, 2, 3, 3, 4});
  pslg.segments.push_back({1, 4, 8});
  add_ring(pslg, {{1, 1}, {4, 1}, {4, 4}, {1, 4}}, {7});
  add_ring(pslg, {{2, 2}, {3, 2}, {3, 3}, {2, 3}}, {6});
  const auto first = static_cast<std::int32_t>(pslg.points.size());
  pslg.points.insert(pslg.points.end(), {{9, 2}, {9, 4}, {6, 5}, {8, 5}});
  pslg.segments.insert(pslg.segments.end(),
                       {{3, first, 5}, {first, first + 1, 5}, {first + 1, 3, 5}, {first + 2, first + 3, 9}});
  pslg.holes = {{1.5, 1.5}, {9.3, 4}};
  pslg.regions = {{{0.5, 0.5}, 10, 0}, {{5.5, 0.5}, 20, 0}};
  return pslg;
}

double area_of(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return signed_area(mesh.points[static_cast<std::size_t>(a)], mesh.points[static_cast<std::size_t>(b)],
                     mesh.points[static_cast<std::size_t>(c)]);
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += area_of(mesh, t);
  return sum;
}

std::map<double, double> area_by_region(const Mesh& mesh) {
  std::map<double, double> areas;
  for (std::size_t t = 0; t < mesh.regions.size(); ++t) areas[mesh.regions[t]] += area_of(mesh, t);
  return areas;
}

std::map<double, double> length_by_marker(const Mesh& mesh) {
  std::map<double, double> lengths;
  for (const Mesh::Edge& e : mesh.edges) {
    const Point &a = mesh.points[static_cast<std::size_t>(e.a)], &b = mesh.points[static_cast<std::size_t>(e.b)];
    lengths[e.marker] += std::hypot(b.x - a.x, b.y - a.y);
  }
  return lengths;
}

void check_same(const std::map<double, double>& found, const std::map<double, double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (const auto& [key, value] : expected) {
    CAPTURE(key);
    REQUIRE(found.contains(key));
    CHECK(found.at(key) == doctest::Approx(value).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("the outline of a mesh in any format is the domain that it covers") {
  const TemporaryFolder folder;
  const Mesh made = mesh(lagoon(), {.max_area = 0.3});
  CHECK(area_of(made) == doctest::Approx(60 - 9 + 1 - 1));
  for (const char* extension : {".vtu", ".msh", ".h5", ".su2", ".14", ".grd", ".gr3", ".ele"}) {
    CAPTURE(std::string(extension));
    const std::string path = (folder.path() / "lagoon").string() + extension;
    write_mesh(made, path, {.open_boundary = {1}});
    const Mesh read = read_mesh(path);
    const Pslg domain = read_input(path).pslg;
    CHECK(domain.holes.size() == 2);
    CHECK(domain.regions.size() == (read.regions.empty() ? 0 : 2));
    CHECK(domain.points.size() < made.points.size());
    const Mesh anew = mesh(domain, {.max_area = 0.1});
    CHECK(anew.triangles.size() > made.triangles.size());
    CHECK(area_of(anew) == doctest::Approx(area_of(made)).epsilon(1e-12));
    check_same(length_by_marker(anew), length_by_marker(read));
    check_same(area_by_region(anew), area_by_region(read));
    CHECK(check(anew, domain, {.max_area = 0.1}).accepted);
  }
}

TEST_CASE("generated domains survive a mesh and its outline") {
  for (const Pslg& input : {generate_rectangle_hole({}), generate_bay({}), generate_comb({})}) {
    const Mesh made = mesh(input);
    const Mesh anew = mesh(outline(made));
    CHECK(area_of(anew) == doctest::Approx(area_of(made)).epsilon(1e-12));
    check_same(length_by_marker(anew), length_by_marker(made));
  }
}

TEST_CASE("what has no outline is refused") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  CHECK(error_text<InputError>([&] { static_cast<void>(outline(mesh, "a.vtu")); }) ==
        "a.vtu: has no triangles; an outline is that of triangles");
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};  // on the same side of an edge
  CHECK(error_text<InputError>([&] { static_cast<void>(outline(mesh, "a.vtu")); }).find("its boundary encloses") !=
        std::string::npos);
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "a.pmesh").string();
  CHECK(error_text<InputError>([&] { static_cast<void>(read_input(path)); }).find("is written, but not read") !=
        std::string::npos);
}
