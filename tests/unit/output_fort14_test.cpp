#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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
  CHECK(read.names.markers == std::map<std::int32_t, std::string>{{3, "open"}});
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

namespace {

struct TextString {
  int type = -1;  // open
  std::vector<std::int32_t> nodes, across;
};

/// Reads the boundaries of a grid as its format is described, and checks all counts.
std::vector<TextString> strings_in(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  const auto numbers = [&] {
    REQUIRE(std::getline(lines, line));
    std::vector<double> values;
    std::istringstream words(line);
    for (double value = 0; words >> value;) values.push_back(value);
    return values;
  };
  numbers();
  const auto sizes = numbers();
  for (double skipped = 0; skipped < sizes[0] + sizes[1]; ++skipped) numbers();
  std::vector<TextString> strings;
  for (const bool open : {true, false}) {
    const double count = numbers()[0], nodes = numbers()[0];
    double listed = 0;
    for (double k = 0; k < count; ++k) {
      const auto header = numbers();
      strings.push_back({open ? -1 : static_cast<int>(header.at(1)), {}, {}});
      for (double i = 0; i < header[0]; ++i) {
        const auto row = numbers();
        strings.back().nodes.push_back(static_cast<std::int32_t>(row[0]) - 1);
        if (row.size() > 3) strings.back().across.push_back(static_cast<std::int32_t>(row[1]) - 1);
        listed += row.size() > 3 ? 2 : 1;
      }
    }
    CHECK(listed == nodes);
  }
  CHECK(!std::getline(lines, line));
  return strings;
}

/// What SCHISM and ADCIRC want of the strings of a mesh; `type_of`: of an edge, -1 where it is open.
void check_strings(const Mesh& mesh, const std::vector<TextString>& strings,
                   const std::function<int(const Directed&)>& type_of) {
  const std::set<Directed> border = border_of(mesh);
  std::set<Directed> covered;
  std::map<std::int32_t, int> ends;  // beginnings less ends
  for (const TextString& string : strings) {
    std::vector<std::int32_t> v = string.nodes;
    CHECK(std::set<std::int32_t>(v.begin(), v.end()).size() == v.size());
    REQUIRE(v.size() >= 2);
    const bool closed = string.type == 1 || string.type == 21;
    if (closed) v.push_back(v.front());
    ++ends[v.front()], --ends[v.back()];
    double area = 0;
    for (std::size_t i = 1; i < v.size(); ++i) {
      const Directed edge{v[i - 1], v[i]};
      CHECK(border.contains(edge));
      CHECK(covered.insert(edge).second);
      const int wanted = type_of(edge);
      CHECK((wanted == string.type || (wanted == 0 && string.type == 1) || (wanted == 21 && string.type == 20)));
      const Point p = mesh.points[static_cast<std::size_t>(edge.first)],
                  q = mesh.points[static_cast<std::size_t>(edge.second)];
      area += p.x * q.y - q.x * p.y;
    }
    if (string.type == 1) CHECK(area < 0);
  }
  CHECK(covered == border);
  for (const auto& [vertex, difference] : ends) CHECK(difference == 0);
}

}  // namespace

TEST_CASE("strings are chains that pass no node twice, and cover the boundary once, whatever touches and is open") {
  auto random = testing::seeded_generator("boundary strings");
  const TemporaryFolder folder;
  const std::string path = folder.path() / "hgrid.gr3";
  int islands = 0, open_strings = 0, pinched = 0, open_rings = 0;
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    Mesh mesh = perforated(random);
    const std::set<Directed> border = border_of(mesh);
    std::map<std::int32_t, int> degree;
    std::map<Directed, int> types;
    const int kinds = 1 + round % 4;  // with few, whole rings are alike
    const std::int32_t first = round % 3;
    mesh.names.markers = {{1, "open"}, {2, "ibtype 22"}, {3, "ibtype 21 of a lagoon"}};
    for (const Directed& edge : border) {
      ++degree[edge.first];
      const auto marker = (first + static_cast<std::int32_t>(random() % static_cast<unsigned>(kinds))) % 4;
      if (marker != 0 || random() % 2 == 0) mesh.edges.push_back({edge.second, edge.first, marker});
      types[edge] = std::array{0, -1, 22, 21}[static_cast<std::size_t>(marker)];
    }
    std::ranges::shuffle(mesh.edges, random);
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& text) {
      if (text.find("two nodes") == std::string::npos) warnings.push_back(text);  // short open boundaries are told, too
    };
    write_mesh(mesh, path, {.warn = warn});
    const auto strings = strings_in(file_bytes(path));
    check_strings(mesh, strings, [&](const Directed& edge) { return types.at(edge); });
    const auto touched = std::ranges::count_if(degree, [](const auto& d) { return d.second > 1; });
    CHECK(warnings.size() == (touched > 0 ? 1 : 0));
    pinched += static_cast<int>(touched);
    for (const TextString& string : strings) islands += string.type == 1 ? 1 : 0;
    for (const TextString& string : strings) open_strings += string.type < 0 ? 1 : 0;
    open_rings += kinds == 1 && first == 1 ? 1 : 0;
    const Mesh again = read_mesh(path);
    write_mesh(again, path);
    check_strings(mesh, strings_in(file_bytes(path)), [&](const Directed& edge) { return types.at(edge); });
    write_mesh(read_mesh(path), folder.path() / "again.14");
    CHECK(file_bytes(folder.path() / "again.14") == file_bytes(path));
  }
  CHECK(islands > 100);
  CHECK(open_strings > 100);
  CHECK(pinched > 100);
  CHECK(open_rings > 10);
}

TEST_CASE("islands that touch the shore, each other or themselves are rings of their own") {
  // Squares of a grid of 6 by 6 that are missing.
  const auto islands = [](const std::vector<std::pair<int, int>>& missing) {
    Mesh mesh;
    for (int y = 0; y <= 6; ++y)
      for (int x = 0; x <= 6; ++x) mesh.points.push_back({static_cast<double>(x), static_cast<double>(y)});
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) {
        if (std::ranges::find(missing, std::pair(x, y)) != missing.end()) continue;
        const std::int32_t a = y * 7 + x, b = a + 1, c = b + 7, d = a + 7;
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    const Boundary boundary = boundary_of(mesh, [](std::int32_t, std::int32_t, std::int32_t) { return EdgeType{}; });
    std::vector<std::size_t> sizes;
    for (const BoundaryString& string : boundary.strings)
      if (string.closed) sizes.push_back(string.vertices.size());
    std::ranges::sort(sizes);
    return std::pair(sizes, boundary.touched.size());
  };
  using Sizes = std::vector<std::size_t>;
  CHECK(islands({{2, 2}}) == std::pair(Sizes{4}, std::size_t{0}));
  CHECK(islands({{2, 2}, {3, 3}}) == std::pair(Sizes{4, 4}, std::size_t{1}));
  CHECK(islands({{2, 2}, {3, 3}, {4, 2}, {3, 1}}) == std::pair(Sizes{4, 4, 4, 4}, std::size_t{4}));
  CHECK(islands({{0, 0}, {1, 1}}) == std::pair(Sizes{4}, std::size_t{1}));
  CHECK(islands({{0, 1}, {1, 2}, {0, 3}}) == std::pair(Sizes{4}, std::size_t{2}));
  // A ring of land around a pond, open at a corner alone.
  CHECK(islands({{1, 1}, {2, 1}, {3, 1}, {3, 2}, {2, 3}, {1, 3}, {1, 2}}) == std::pair(Sizes{12}, std::size_t{1}));
}

TEST_CASE("a ring that is open all around is two strings, as SCHISM's manual has it") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "hgrid.gr3";
  Mesh mesh = square();
  write_mesh(mesh, path, {.open_boundary = {7, -2}});
  const auto strings = strings_in(file_bytes(path));
  REQUIRE(strings.size() == 2);
  CHECK(strings[0].type == -1);
  CHECK(strings[0].nodes == std::vector<std::int32_t>{0, 1, 2});
  CHECK(strings[1].nodes == std::vector<std::int32_t>{2, 3, 0});
  write_mesh(mesh, path);
  CHECK(strings_in(file_bytes(path)).size() == 2);
}

TEST_CASE("boundaries of one type that follow each other stay apart") {
  const TemporaryFolder folder;
  const std::string nodes = "t\n2 4\n1 0 0 2\n2 1 0 2\n3 1 1 2\n4 0 1 2\n1 3 1 2 3\n2 3 1 3 4\n";
  const std::pair<std::string, std::size_t> cases[] = {
      {"2\n5\n2\n1\n2\n3\n2\n3\n4\n1\n2\n2 20\n4\n1\n", 3},
      {"3\n6\n2\n1\n2\n2\n2\n3\n2\n3\n4\n1\n2\n2 0\n4\n1\n", 4},
      {"1\n2\n2\n1\n2\n3\n6\n2 20\n2\n3\n2 20\n3\n4\n2 20\n4\n1\n", 4}};
  for (const auto& [boundaries, count] : cases)
    for (const char* file : {"grid.14", "grid.gr3", "grid.msh", "grid.vtu"}) {
      CAPTURE(boundaries);
      CAPTURE(file);
      write_mesh(parse_fort14("grid.14", nodes + boundaries), folder.path() / file);
      write_mesh(read_mesh(folder.path() / file), folder.path() / "again.14");
      CHECK(strings_in(file_bytes(folder.path() / "again.14")).size() == count);
    }
}

TEST_CASE("a mesh with a triangle that is turned is written") {
  const TemporaryFolder folder;
  Mesh mesh = square();
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  write_mesh(mesh, folder.path() / "fort.14");
  CHECK(read_mesh(folder.path() / "fort.14").triangles == mesh.triangles);
}

TEST_CASE("weirs, rivers and other types of ADCIRC are kept, or it is said what is lost") {
  const TemporaryFolder folder;
  // A grid of 5 by 2 squares; the squares in the middle of a row of three are a weir's place.
  Mesh grid;
  for (int y = 0; y <= 3; ++y)
    for (int x = 0; x <= 5; ++x) grid.points.push_back({static_cast<double>(x), static_cast<double>(y)});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) {
      if (y == 1 && x >= 1 && x <= 3) continue;
      const std::int32_t a = y * 6 + x, b = a + 1, c = b + 6, d = a + 6;
      grid.triangles.push_back({a, b, c});
      grid.triangles.push_back({a, c, d});
    }
  const std::string bare = folder.path() / "bare.14";
  write_mesh(grid, bare);
  std::string text = file_bytes(bare);
  text.erase(text.find("0 = number of open boundaries"));
  const std::string boundaries =
      "1 = number of open boundaries\n4 = number of nodes on open boundaries\n"
      "4 = number of nodes on this open boundary\n1\n2\n3\n4\n"
      "5 = number of land boundaries\n22 = number of nodes on land boundaries\n"
      "3 52 = number of nodes on this land boundary, type\n4\n5\n6\n"
      "2 52 = number of nodes on this land boundary, type\n24\n23\n"
      "4 20 = number of nodes on this land boundary, type\n6\n12\n18\n24\n"
      "5 23 = number of nodes on this weir, type\n23 1.5 1\n22 1.5 1\n21 1.25 1\n20 1 1\n19 1 0.5\n"
      "4 24 = number of nodes on this weir, type\n17 11 2.5 1 0.9\n16 10 2.5 1 1\n15 9 2.25 1 1\n14 8 2 1 1\n";
  const std::string given = text + boundaries;
  // What is left is the shore in the west, which was not listed.
  const Mesh mesh = parse_fort14("given.14", given);
  CHECK(mesh.names.markers ==
        std::map<std::int32_t, std::string>{
            {3, "open"}, {120, "ibtype 20"}, {123, "ibtype 23"}, {124, "ibtype 24"}, {152, "ibtype 52"}});
  REQUIRE(mesh.weirs.size() == 2);
  CHECK(mesh.weirs[0] == Mesh::Weir{23, {22, 21, 20, 19, 18}, {}, {1.5, 1, 1.5, 1, 1.25, 1, 1, 1, 1, 0.5}});
  CHECK(mesh.weirs[1] ==
        Mesh::Weir{24, {16, 15, 14, 13}, {10, 9, 8, 7}, {2.5, 1, 0.9, 2.5, 1, 1, 2.25, 1, 1, 2, 1, 1}});

  std::vector<std::string> warnings;
  const auto written = [&](const Mesh& from, const char* name) {
    warnings.clear();
    write_mesh(from, folder.path() / name, {.warn = [&](const std::string& said) { warnings.push_back(said); }});
    return folder.path() / name;
  };
  const auto said = [&] { return warnings.empty() ? "" : warnings[0].substr(warnings[0].rfind('/') + 1); };

  const std::string same = file_bytes(written(mesh, "same.14"));
  CHECK(warnings.empty());
  std::string whole = boundaries;
  whole.replace(whole.find("5 = number of land"), 1, "6");
  whole.replace(whole.find("22 = number of nodes"), 2, "26");
  whole.insert(whole.find("5 23 ="), "4 0 = number of nodes on this land boundary, type\n19\n13\n7\n1\n");
  CHECK(same == text + whole);
  CHECK(file_bytes(written(read_mesh(folder.path() / "same.14"), "again.grd")) == same);

  // SCHISM knows no weirs: their sides are land and islands there.
  const auto strings = strings_in(file_bytes(written(mesh, "hgrid.gr3")));
  CHECK(said() == "hgrid.gr3: weirs become land: ibtype 23 (1 string), ibtype 24 (1 string); SCHISM has none");
  const std::set<Directed> border = border_of(mesh);
  std::map<Directed, int> types;
  for (const Directed& edge : border) types[edge] = 0;
  for (const Directed& edge : {Directed{3, 4}, {4, 5}, {23, 22}}) types[edge] = 52;
  for (const Directed& edge : {Directed{0, 1}, {1, 2}, {2, 3}}) types[edge] = -1;
  for (const Directed& edge : {Directed{5, 11}, {11, 17}, {17, 23}}) types[edge] = 20;
  check_strings(mesh, strings, [&](const Directed& edge) { return types.at(edge); });

  // By names types go through other files, heights do not.
  for (const char* name : {"m.vtu", "m.msh", "m.su2", "m.h5"}) {
    CAPTURE(name);
    const Mesh back = read_mesh(written(mesh, name));
    CHECK(said() == std::string(name) + ": has no place for the heights and coefficients of weirs: " +
                        "ibtype 23 (1 string), ibtype 24 (1 string)");
    const auto after = strings_in(file_bytes(written(back, "after.14")));
    CHECK(said().starts_with("after.14: weirs become land: ibtype 23 (1 string), ibtype 24 ("));
    check_strings(mesh, after, [&](const Directed& edge) { return types.at(edge); });
  }
  written(mesh, "m.node");
  CHECK(said() ==
        "m.node: has no place for types of boundaries, of which markers remain: open (1 string), "
        "ibtype 20 (1 string), ibtype 23 (1 string), ibtype 24 (1 string), ibtype 52 (2 strings); "
        "the heights and coefficients of weirs: ibtype 23 (1 string), ibtype 24 (1 string)");
  written(square(), "m.node");
  CHECK(warnings.empty());
}

TEST_CASE("a grid of another program is read, with comments, weirs and Fortran's exponents") {
  const Mesh mesh = parse_fort14(
      "fort.14",
      "Bay of somewhere! 2026\r\n"
      "  2, 4   ! NE, NP\r\n"
      "   1   1.0D+01  0.0  -3.5D-01\r\n 2 +2.0e1 0 2\r\n3 2.0E+01 1.0d1 2.\r\n4 10 10 2 depth\r\n"
      "1 3 1 2 3\r\n2 3 1 3 4\r\n"
      "1 = open\r\n2\r\n2 = nodes\r\n1\r\n2\r\n"
      "2\r\n5\r\n2 20 = land\r\n2\r\n3\r\n3 24 weir\r\n3 1 0.5 1.0 1\r\n4 2 0.5 1.0 1.\r\n1 2 5D-1 1 1 ! m\r\n\r\n");
  CHECK(mesh.points[0].x == 10);
  CHECK(mesh.points[1].x == 20);
  CHECK(mesh.attributes == std::vector<double>{-0.35, 2, 2, 2});
  CHECK(mesh.edges == std::vector<Mesh::Edge>{{0, 1, 3}, {1, 2, 120}, {2, 3, 124}, {3, 0, 124}});
  REQUIRE(mesh.weirs.size() == 1);
  CHECK(mesh.weirs[0] == Mesh::Weir{24, {2, 3, 0}, {0, 1, 1}, {0.5, 1, 1, 0.5, 1, 1, 0.5, 1, 1}});
  const Mesh bare =
      parse_fort14("bare.gr3", "x\n1 3\n1 0 0 1\n2 1 0 1\n3 0 1 1\n1 3 1 2 3\n0\n0\n1\n3\n3 24\n1 a\n2\n3\n");
  CHECK(bare.weirs.empty());
  CHECK(bare.edges == std::vector<Mesh::Edge>{{0, 1, 124}, {1, 2, 124}});
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
  CHECK(with("3 1\n1\n2\n3\n", "3 3\n1 2.5 1\n2 2.5\n3 2.5 1\n")
            .starts_with("g.14:13: lacks a height or a coefficient of a weir"));
  CHECK(with("3 1\n1\n2\n3\n", "3 -7\n1\n2\n3\n").starts_with("g.14:11: has -7 as the type of a boundary"));
  CHECK(with("0 1 0\n", "0 nan 0\n") != "nothing");
  CHECK(message("") != "nothing");
  for (std::size_t length = 0; length < whole.size(); ++length)
    static_cast<void>(message(whole.substr(0, length)));  // no worse than an InputError
}
