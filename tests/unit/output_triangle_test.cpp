#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

using Row = std::vector<long>;
using VertexPair = std::pair<std::int32_t, std::int32_t>;

std::vector<Row> rows_of(const std::string& path) {
  std::istringstream text(file_bytes(path));
  std::vector<Row> rows;
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (long value = 0; fields >> value;) rows.back().push_back(value);
  }
  return rows;
}

VertexPair sorted(std::int32_t a, std::int32_t b) {
  return std::minmax({a, b});
}

// Which triangles have each edge, by a map.
std::map<VertexPair, std::vector<std::size_t>> triangles_by_edge(const Mesh& mesh) {
  std::map<VertexPair, std::vector<std::size_t>> result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      result[sorted(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3])].push_back(t);
  return result;
}

}  // namespace

TEST_CASE("the .neigh file names the triangle across each edge") {
  const TemporaryFolder folder;
  const RandomMesh random(11, 7, 6);
  const Mesh& mesh = random.mesh();
  write_mesh(mesh, folder.path() / "mesh.node");
  const auto rows = rows_of(folder.path() / "mesh.neigh");
  REQUIRE(rows.size() == mesh.triangles.size() + 1);
  CHECK(rows[0] == Row{static_cast<long>(mesh.triangles.size()), 3});
  const auto by_edge = triangles_by_edge(mesh);
  std::size_t without = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    REQUIRE(rows[t + 1].size() == 4);
    CHECK(rows[t + 1][0] == static_cast<long>(t + 1));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& both = by_edge.at(sorted(mesh.triangles[t][(i + 1) % 3], mesh.triangles[t][(i + 2) % 3]));
      long expected = -1;
      for (std::size_t other : both)
        if (other != t) expected = static_cast<long>(other) + 1;
      CHECK(rows[t + 1][i + 1] == expected);
      without += expected == -1 ? 1 : 0;
    }
  }
  CHECK(without == 2 * (7 + 6) + 4);
}

TEST_CASE("the .edge file lists each edge once, with the marker of its segment") {
  const TemporaryFolder folder;
  const RandomMesh random(12, 6, 7);
  const Mesh& mesh = random.mesh();
  write_mesh(mesh, folder.path() / "mesh.node");
  const auto rows = rows_of(folder.path() / "mesh.edge");
  const auto by_edge = triangles_by_edge(mesh);
  REQUIRE(rows.size() == by_edge.size() + 1);
  CHECK(rows[0] == Row{static_cast<long>(by_edge.size()), 1});
  std::map<VertexPair, std::int32_t> markers;
  for (const auto& edge : mesh.edges) markers[sorted(edge.a, edge.b)] = edge.marker;
  std::set<VertexPair> seen;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    REQUIRE(rows[i].size() == 4);
    CHECK(rows[i][0] == static_cast<long>(i));
    const VertexPair edge =
        sorted(static_cast<std::int32_t>(rows[i][1] - 1), static_cast<std::int32_t>(rows[i][2] - 1));
    CHECK(by_edge.contains(edge));
    CHECK(seen.insert(edge).second);
    CHECK(rows[i][3] == (markers.contains(edge) ? markers.at(edge) : 0));
  }
}

TEST_CASE("neighbors of a fan of 200,000 triangles around one vertex take linear time") {
  const TemporaryFolder folder;
  Mesh mesh;
  constexpr std::int32_t kSpokes = 200000;
  mesh.points.push_back({0, 0});
  for (std::int32_t i = 0; i <= kSpokes; ++i) mesh.points.push_back({1.0 * i, 1.0 + 1e-3 * i});
  for (std::int32_t i = 1; i <= kSpokes; ++i) mesh.triangles.push_back({0, i + 1, i});
  write_mesh(mesh, folder.path() / "fan.node");
  const auto rows = rows_of(folder.path() / "fan.neigh");
  REQUIRE(rows.size() == kSpokes + 1);
  CHECK(rows[1] == Row{1, -1, -1, 2});
  CHECK(rows[1000] == Row{1000, -1, 999, 1001});
}

TEST_CASE("without a .poly the constrained edges come from the marked edges of .edge") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.ele";
  RandomMesh random(13, 4, 4);
  write_mesh(random.mesh(), path);
  std::filesystem::remove(folder.path() / "mesh.poly");
  std::set<std::pair<VertexPair, std::int32_t>> expected;
  for (const auto& edge : random.mesh().edges)
    if (edge.marker != 0) expected.insert({sorted(edge.a, edge.b), edge.marker});
  std::set<std::pair<VertexPair, std::int32_t>> actual;
  for (const auto& edge : read_mesh(path).edges) actual.insert({sorted(edge.a, edge.b), edge.marker});
  CHECK(actual == expected);
  CHECK(actual.size() > 5);
  std::filesystem::remove(folder.path() / "mesh.edge");
  CHECK(read_mesh(path).edges.empty());
}

TEST_CASE("a .poly with vertices of its own is an input and not part of the mesh") {
  const TemporaryFolder folder;
  write_mesh(RandomMesh(14, 2, 2).mesh(), folder.path() / "mesh.ele");
  replace_file(folder.path() / "mesh.poly", "2 2 0 0\n1 0 0\n2 5 5\n1 1\n1 1 2 44\n0\n");
  for (const auto& edge : read_mesh(folder.path() / "mesh.ele").edges) CHECK(edge.marker != 44);
}

TEST_CASE("given holes are written to the .poly") {
  const TemporaryFolder folder;
  write_mesh(RandomMesh(15, 3, 3).mesh(), folder.path() / "mesh.poly", {.holes = {{0.5, 0.25}}});
  const std::string text = file_bytes(folder.path() / "mesh.poly");
  CHECK(text.ends_with("\n1\n1 0.5 0.25\n"));
}

TEST_CASE("truncated or damaged files of Triangle are rejected or read, but never crash the reader") {
  const TemporaryFolder folder;
  write_mesh(RandomMesh(16, 2, 2).mesh(), folder.path() / "mesh.node");
  for (const char* extension : {".node", ".ele", ".poly"}) {
    CAPTURE(extension);
    const std::string path = folder.path() / (std::string("mesh") + extension);
    const auto read = [&] { (void)read_mesh(folder.path() / "mesh.ele"); };
    const DamageCount truncated = read_truncated(path, read);
    CHECK(truncated.refused > 10);
    const DamageCount flipped = read_flipped(path, 500, 7, read);
    CHECK(flipped.refused > 10);
  }
}

TEST_CASE("an unknown extension is rejected with the known ones") {
  const Mesh mesh;
  CHECK_THROWS_WITH_AS(write_mesh(mesh, "a.stl"), doctest::Contains("unknown extension '.stl'; a mesh file is"),
                       InputError);
  CHECK_THROWS_AS((void)read_mesh("mesh"), InputError);
  CHECK_THROWS_AS((void)mesh_files("mesh.txt"), InputError);
  CHECK(mesh_files("a/b.ele").size() == 5);
  CHECK(mesh_files("a/b.vtu") == std::vector<std::string>{"a/b.vtu"});
}
