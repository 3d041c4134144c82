// The real Gmsh reads our files and writes files that we read.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

bool gmsh_is_installed() {
  const bool found = std::system("gmsh --version > /dev/null 2>&1") == 0;
  if (!found) MESSAGE("skipped: gmsh is not installed");
  return found;
}

std::string run_gmsh(const std::string& arguments, const std::filesystem::path& folder) {
  const std::string log = folder / "gmsh.log";
  const std::string command = "gmsh " + arguments + " > '" + log + "' 2>&1";
  const int status = std::system(command.c_str());
  const std::string said = file_bytes(log);
  INFO(command, "\n", said);
  CHECK(status == 0);
  CHECK(said.find("Error") == std::string::npos);
  CHECK(said.find("Warning") == std::string::npos);
  return said;
}

// How many elements of each type and physical group an ASCII file of format 2.2 lists; names of groups by dimension
// and tag.
struct Msh22 {
  explicit Msh22(const std::string& path) {
    std::istringstream text(file_bytes(path));
    for (std::string line; std::getline(text, line);) {
      if (line == "$PhysicalNames") read_names(text);
      if (line == "$Elements") read_elements(text);
    }
  }
  std::map<std::pair<int, int>, int> elements;
  std::map<std::pair<int, int>, std::string> names;

 private:
  void read_names(std::istream& text) {
    int count = 0;
    for (text >> count; count > 0; --count) {
      int dimension = 0;
      int tag = 0;
      std::string name;
      text >> dimension >> tag;
      std::getline(text, name);
      names[{dimension, tag}] = name.substr(2, name.size() - 3);
    }
  }
  void read_elements(std::istream& text) {
    int count = 0;
    for (text >> count; count > 0; --count) {
      int number = 0;
      int type = 0;
      int tags = 0;
      int physical = 0;
      std::string rest;
      text >> number >> type >> tags >> physical;
      std::getline(text, rest);
      ++elements[{type, physical}];
    }
  }
};

// A mesh compared regardless of order, since Gmsh renumbers nodes and elements.
struct Unordered {
  using Key = std::pair<long long, long long>;  // coordinates in units of 1e-12
  explicit Unordered(const Mesh& mesh) {
    const auto key = [&mesh](std::int32_t v) {
      const Point& p = mesh.points[v];
      return Key{std::llround(p.x * 1e12), std::llround(p.y * 1e12)};
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      triangles.insert({{key(a), key(b), key(c)}, mesh.regions[t]});
    }
    for (const auto& edge : mesh.edges) edges.insert({{key(edge.a), key(edge.b)}, edge.marker});
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      attributes.insert({{key(static_cast<std::int32_t>(v))}, mesh.attributes[v]});
  }
  std::set<std::pair<std::vector<Key>, double>> triangles;
  std::set<std::pair<std::vector<Key>, std::int32_t>> edges;
  std::set<std::pair<std::vector<Key>, double>> attributes;
};

}  // namespace

TEST_CASE("Gmsh finds every element in its physical group") {
  if (!gmsh_is_installed()) return;
  const TemporaryFolder folder;
  const RandomMesh random(21, 9, 8);
  const Mesh& mesh = random.mesh();
  const std::string written = folder.path() / "mesh.msh";
  const std::string back = folder.path() / "back.msh";
  write_mesh(mesh, written);
  const std::string said = run_gmsh("'" + written + "' -0 -format msh22 -o '" + back + "'", folder.path());
  CHECK(said.find(std::to_string(mesh.points.size()) + " nodes") != std::string::npos);
  CHECK(said.find(std::to_string(mesh.edges.size() + mesh.triangles.size()) + " elements") != std::string::npos);

  Msh22 file(back);
  std::map<std::string, int> expected;
  for (const auto& edge : mesh.edges) ++expected["marker " + std::to_string(edge.marker)];
  for (double region : mesh.regions) ++expected[region == 7 ? "region 7" : "region -1.25"];
  std::map<std::string, int> actual;
  for (const auto& [type_and_group, count] : file.elements)
    actual[file.names.at(type_and_group)] += count;  // Gmsh's types 1 and 2 happen to be the dimensions
  CHECK(actual == expected);
  CHECK(expected.size() >= 6);
  for (const auto& [tag, marker] : {std::pair(1, 1), {2, 2}, {5, 5}, {INT32_MAX, INT32_MAX}, {1000000, 0}}) {
    const std::string name = "marker " + std::to_string(marker);
    if (expected.contains(name)) CHECK(file.names[{1, tag}] == name);
  }
}

TEST_CASE("Gmsh shows the subdomain and the rank of the triangles") {
  if (!gmsh_is_installed()) return;
  const TemporaryFolder folder;
  Mesh mesh = RandomMesh(23, 6, 5).mesh();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.subdomains.push_back(static_cast<std::int32_t>(t % 11));
    mesh.ranks.push_back(static_cast<std::int32_t>(t % 11 / 4));
  }
  const std::string written = folder.path() / "mesh.msh";
  const std::string script = folder.path() / "views.geo";
  write_mesh(mesh, written);
  // Views are loaded with the mesh; Gmsh writes each as text: one line for each element, its value last.
  replace_file(script, "Merge \"" + written + "\";\nFor i In {0 : PostProcessing.NbViews - 1}\n" +
                           "  Save View[i] Sprintf(\"" + (folder.path() / "view%g.pos").string() + "\", i);\nEndFor\n");
  // Print only errors: for each view, Gmsh warns about higher orders, which the text does not contain.
  run_gmsh("-v 1 '" + script + "' -0 -o '" + (folder.path() / "ignored.msh").string() + "'", folder.path());
  for (const auto& [values, name] : {std::pair(&mesh.subdomains, "subdomain"), {&mesh.ranks, "rank"}}) {
    CAPTURE(name);
    std::map<int, int> expected, actual;
    for (const std::int32_t value : *values) ++expected[value];
    bool found = false;
    for (std::size_t view = 0; std::filesystem::exists(folder.path() / ("view" + std::to_string(view) + ".pos"));
         ++view) {
      const std::string text = file_bytes(folder.path() / ("view" + std::to_string(view) + ".pos"));
      if (text.find(std::string("\"") + name + "\"") == std::string::npos) continue;
      found = true;
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);)
        if (line.starts_with("ST(")) ++actual[std::stoi(line.substr(line.find('{') + 1))];
    }
    CHECK(found);
    CHECK(actual == expected);
  }
}

TEST_CASE("what Gmsh writes is read with all markers and regions") {
  if (!gmsh_is_installed()) return;
  const TemporaryFolder folder;
  const RandomMesh random(22, 8, 9, {.attributes_per_point = 1});
  const std::string written = folder.path() / "mesh.msh";
  const std::string back = folder.path() / "back.msh";
  write_mesh(random.mesh(), written);
  const Unordered expected(random.mesh());
  for (const char* encoding : {"", " -bin"}) {
    CAPTURE(encoding);
    run_gmsh("'" + written + "' -0 -save_all -format msh41" + encoding + " -o '" + back + "'", folder.path());
    Mesh read = read_mesh(back);
    CHECK(read.attributes_per_point == 0);  // Gmsh saves views to files of their own
    read.attributes = random.mesh().attributes;
    const Unordered actual(read);
    CHECK(actual.triangles == expected.triangles);
    CHECK(actual.edges == expected.edges);
  }
}

TEST_CASE("a mesh that Gmsh made is read") {
  if (!gmsh_is_installed()) return;
  const TemporaryFolder folder;
  const std::string geometry = folder.path() / "in.geo";
  replace_file(geometry,
               "lc = 0.2;\n"
               "Point(1) = {0,0,0,lc}; Point(2) = {2,0,0,lc}; Point(3) = {2,1,0,lc}; Point(4) = {0,1,0,lc};\n"
               "Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};\n"
               "Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};\n"
               "Physical Curve(\"inlet\", 11) = {4}; Physical Curve(\"wall\", 12) = {1,3};\n"
               "Physical Curve(13) = {2}; Physical Surface(\"fluid\", 4) = {1};\n");
  for (const char* options : {"", " -bin", " -save_all", " -parametric"}) {
    CAPTURE(options);
    const std::string mesh_path = folder.path() / "made.msh";
    run_gmsh("'" + geometry + "' -2 -format msh41" + options + " -o '" + mesh_path + "'", folder.path());
    const Mesh mesh = read_mesh(mesh_path);
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Point& p = mesh.points[a];
      const Point& q = mesh.points[b];
      const Point& r = mesh.points[c];
      area += ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
    }
    CHECK(area == doctest::Approx(2));
    CHECK(mesh.regions == std::vector<double>(mesh.triangles.size(), 4));
    std::map<std::int32_t, double> length;
    for (const auto& edge : mesh.edges) {
      const Point& p = mesh.points[edge.a];
      const Point& q = mesh.points[edge.b];
      length[edge.marker] += std::hypot(q.x - p.x, q.y - p.y);
    }
    CHECK(length.size() == 3);
    CHECK(length[11] == doctest::Approx(1));
    CHECK(length[12] == doctest::Approx(4));
    CHECK(length[13] == doctest::Approx(1));
  }
}
