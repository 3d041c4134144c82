#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "driftmesh/error.hpp"
#include "io/boundary_strings.hpp"
#include "io/fort14_format.hpp"
#include "io/mesh_file.hpp"
#include "property/cases.hpp"
#include "support/damage.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

/// A square of four triangles around its center, and one of its corners missing or not.
Mesh square() {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  mesh.edges = {{0, 1, 7}, {1, 2, -2}, {2, 3, 7}, {0, 3, 7}, {0, 4, 5}};
  return mesh;
}

/// A grid of squares, two triangles each, without some of them: islands, bays, and corners where two of them touch.
Mesh perforated(std::mt19937_64& random) {
  constexpr int kSide = 9;
  Mesh mesh;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) mesh.points.push_back({static_cast<double>(x), static_cast<double>(y)});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      if (random() % 4 == 0) continue;
      const std::int32_t a = y * (kSide + 1) + x, b = a + 1, c = b + kSide + 1, d = a + kSide + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

using Directed = std::pair<std::int32_t, std::int32_t>;

/// Edges with a triangle on their left only, from the triangles alone.
std::set<Directed> border_of(const Mesh& mesh) {
  std::set<Directed> all, border;
  for (const auto& [a, b, c] : mesh.triangles) all.insert({{a, b}, {b, c}, {c, a}});
  for (const auto& [a, b] : all)
    if (!all.contains({b, a})) border.insert({a, b});
  return border;
}

}  // namespace

TEST_CASE("a .14 has nodes with depths, elements, and its boundary by kinds") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "fort.14";
  write_mesh(square(), path, {.open_boundary = {-2}});
  CHECK(file_bytes(path) ==
        "driftmesh\n"
        "4 5 = number of elements and nodes\n"
        "1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 1 0\n"
        "1 3 1 2 5\n2 3 2 3 5\n3 3 3 4 5\n4 3 4 1 5\n"
        "1 = number of open boundaries\n"
        "2 = number of nodes on open boundaries\n"
        "2 = number of nodes on this open boundary\n2\n3\n"
        "1 = number of land boundaries\n"
        "4 = number of nodes on land boundaries\n"
        "4 0 = number of nodes on this land boundary, type\n3\n4\n1\n2\n");
  const Mesh read = read_mesh(path);
  CHECK(read.points == square().points);
  CHECK(read.triangles == square().triangles);
  CHECK(read.edges == std::vector<Mesh::Edge>{{1, 2, 3}, {2, 3, 1}, {3, 0, 1}, {0, 1, 1}});
  CHECK(read.attributes.empty());
}

TEST_CASE("depths come back as the attribute of points") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "hgrid.gr3";
  Mesh mesh = square();
  mesh.attributes_per_point = 2;
  mesh.attributes = {0.1, 9, -2.5, 9, 1e-300, 9, 4, 9, 1. / 3, 9};
  write_mesh(mesh, path);
  const Mesh read = read_mesh(path);
  CHECK(read.attributes_per_point == 1);
  CHECK(read.attributes == std::vector<double>{0.1, -2.5, 1e-300, 4, 1. / 3});
}

TEST_CASE("strings cover the boundary once, end where the next one begins, and islands are closed") {
  auto random = testing::seeded_generator("boundary strings");
  int islands = 0, open_strings = 0, pinched = 0;
  for (int round = 0; round < 200; ++round) {
    CAPTURE(round);
    Mesh mesh = perforated(random);
    const std::set<Directed> border = border_of(mesh);
    std::map<std::int32_t, int> degree;
    for (const Directed& edge : border) {
      ++degree[edge.first];
      mesh.edges.push_back({edge.second, edge.first, static_cast<std::int32_t>(random() % 3)});
    }
    pinched += static_cast<int>(std::ranges::count_if(degree, [](const auto& d) { return d.second > 1; }));
    std::map<Directed, bool> is_open;
    const bool any_open = round % 3 != 0;
    for (const Mesh::Edge& edge : mesh.edges) is_open[{edge.b, edge.a}] = any_open && edge.marker == 2;
    const auto strings = boundary_strings(mesh, [&](std::int32_t marker) { return any_open && marker == 2; });

    std::set<Directed> covered;
    std::map<std::int32_t, int> ends;  // beginnings less ends
    for (const BoundaryString& string : strings) {
      std::vector<std::int32_t> v = string.vertices;
      if (string.kind == BoundaryString::Kind::kIsland) v.push_back(v.front()), ++islands;
      REQUIRE(v.size() >= 2);
      ++ends[v.front()], --ends[v.back()];
      double area = 0;
      for (std::size_t i = 1; i < v.size(); ++i) {
        const Directed edge{v[i - 1], v[i]};
        CHECK(border.contains(edge));
        CHECK(covered.insert(edge).second);
        CHECK(is_open[edge] == (string.kind == BoundaryString::Kind::kOpen));
        const Point p = mesh.points[static_cast<std::size_t>(edge.first)],
                    q = mesh.points[static_cast<std::size_t>(edge.second)];
        area += p.x * q.y - q.x * p.y;
      }
      if (string.kind == BoundaryString::Kind::kIsland) CHECK(area < 0);
      if (string.kind == BoundaryString::Kind::kLand && v.front() == v.back() && !any_open) CHECK(area > 0);
      open_strings += string.kind == BoundaryString::Kind::kOpen ? 1 : 0;
    }
    CHECK(covered == border);
    for (const auto& [vertex, difference] : ends) CHECK(difference == 0);
  }
  CHECK(islands > 100);
  CHECK(open_strings > 100);
  CHECK(pinched > 100);
}

TEST_CASE("a grid of another program is read, with comments, weirs and Fortran's exponents") {
  const Mesh mesh =
      parse_fort14("fort.14",
                   "Bay of somewhere! 2026\r\n"
                   "  2, 4   ! NE, NP\r\n"
                   "   1   1.0D+01  0.0  -3.5D-01\r\n 2 +2.0e1 0 2\r\n3 2.0E+01 1.0d1 2.\r\n4 10 10 2 depth\r\n"
                   "1 3 1 2 3\r\n2 3 1 3 4\r\n"
                   "1 = open\r\n2\r\n2 = nodes\r\n1\r\n2\r\n"
                   "2\r\n5\r\n2 20 = land\r\n2\r\n3\r\n3 24 weir\r\n3 1 0.5 1.0\r\n4 2 0.5 1.0\r\n1 2 0.5\r\n\r\n");
  CHECK(mesh.points[0].x == 10);
  CHECK(mesh.points[1].x == 20);
  CHECK(mesh.attributes == std::vector<double>{-0.35, 2, 2, 2});
  CHECK(mesh.edges == std::vector<Mesh::Edge>{{0, 1, 3}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}});
  CHECK(parse_fort14("no boundaries.grd", "x\n1 3\n1 0 0 1\n2 1 0 1\n3 0 1 1\n1 3 1 2 3\n").edges.empty());
}

TEST_CASE("what is wrong in a grid is named with its line") {
  const std::string whole = "t\n1 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 3 1 2 3\n0\n0\n1\n3\n3 1\n1\n2\n3\n";
  CHECK(parse_fort14("g.14", whole).edges.size() == 3);
  const auto message = [&](const std::string& text) {
    try {
      static_cast<void>(parse_fort14("g.14", text));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto with = [&](const std::string& old, const std::string& changed) {
    std::string text = whole;
    return message(text.replace(text.find(old), old.size(), changed));
  };
  CHECK(with("1 3\n", "1000000000 3\n").starts_with("g.14:2: has 1000000000 as the number of elements"));
  CHECK(with("1 3\n", "-1 3\n").starts_with("g.14:2: has -1"));
  CHECK(with("2 1 0 0", "2 1 zero 0").starts_with("g.14:4: has 'zero' in place of y"));
  CHECK(with("2 1 0 0", "2 1 0").starts_with("g.14:4: lacks the depth"));
  CHECK(with("2 1 0 0", "7 1 0 0").starts_with("g.14:4: is not node 2"));
  CHECK(with("1 3 1 2 3", "1 4 1 2 3 4").starts_with("g.14:6: has an element of 4 nodes"));
  CHECK(with("1 3 1 2 3", "1 3 1 2 9").starts_with("g.14:6: names node 9"));
  CHECK(with("3 1\n1\n2\n3\n", "3 1\n1\n2\n").starts_with("g.14:13: ends before all nodes of a boundary are listed"));
  CHECK(with("0 1 0\n", "0 nan 0\n") != "nothing");
  CHECK(message("") != "nothing");
  for (std::size_t length = 0; length < whole.size(); ++length)
    static_cast<void>(message(whole.substr(0, length)));  // no worse than an InputError
}
