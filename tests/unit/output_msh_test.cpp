#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/msh_groups.hpp"
#include "support/damage.hpp"
#include "support/error_text.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "support/round_trip.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;
using namespace driftmesh::test;

namespace {

// Two triangles of a square as Gmsh writes them in ASCII: a surface in a named group, two curves in groups, two not;
// tags with gaps; a point element; parametric nodes on a curve.
const char* const kGmshText = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "inlet"
2 3 "fluid"
$EndPhysicalNames
$Entities
1 3 1 0
1 0 0 0 0
1 0 0 0 1 0 0 1 7 2 1 -1
2 1 0 0 1 1 0 1 9 0
3 0 0 0 1 1 0 0 0
1 0 0 0 1 1 0 1 3 3 1 2 3
$EndEntities
$Nodes
3 4 1 12
0 1 0 1
1
0 0 0
1 1 1 1
5
1 0 0 0.5
2 1 0 2
10
12
1 1 0
0 1 0
$EndNodes
$Elements
5 6 1 20
0 1 15 1
1 1
1 1 1 1
2 1 5
1 2 1 1
3 5 10
1 3 1 1
4 10 12
2 1 2 2
19 1 5 10
20 1 10 12
$EndElements
)";

Mesh mesh_of_gmsh_text() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{0, 1, 7}, {1, 2, 9}, {2, 3, 0}};
  mesh.regions = {3, 3};
  mesh.names = {{{7, "inlet"}}, {{3, "fluid"}}};
  return mesh;
}

std::string message_of(const std::string& path, const std::string& bytes) {
  replace_file(path, bytes);
  return error_text<InputError>([&] { (void)read_mesh(path); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("an ASCII .msh reads back as the mesh that was written") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  check_random_meshes_read_back(path, format_of(path).keeps, {.ascii = true});
}

// meshio takes values on nodes and elements in the order of the file and insists on these numbers.
TEST_CASE(
    "nodes and elements of a .msh are numbered from 1 as they stand in the file, and views have a value for each") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{2, 3, 5}, {0, 1, 4}, {3, 0, 5}};
  mesh.regions = {2, 1};
  mesh.subdomains = {7, 8};
  write_mesh(mesh, path, {.ascii = true});
  const std::string text = file_bytes(path);
  CHECK(text.find("$Elements\n5 5 1 5\n"
                  "2 2 2 1\n1 1 2 3\n"
                  "2 1 2 1\n2 1 3 4\n"
                  "1 5 1 1\n3 3 4\n"
                  "1 4 1 1\n4 1 2\n"
                  "1 5 1 1\n5 4 1\n"
                  "$EndElements\n") != std::string::npos);
  CHECK(text.find("\n5\n1 7\n2 8\n3 8\n4 7\n5 8\n$EndElementData\n") != std::string::npos);
  check_same_mesh(read_mesh(path), mesh);
}

TEST_CASE("views on elements are data at triangles if each triangle has one value") {
  const auto view = [](const std::string& name, const std::string& values, int components = 1) {
    return "$ElementData\n1\n\"" + name + "\"\n1\n0\n3\n0\n" + std::to_string(components) + "\n" +
           std::to_string(std::ranges::count(values, '\n')) + "\n" + values + "$EndElementData\n";
  };
  const std::string text = kGmshText + view("h", "20 2.5\n19 -1\n") + view("lines too", "4 9\n5 9\n19 1\n20 2\n") +
                           view("lines alone", "4 9\n5 9\n") + view("one is missing", "19 1\n3 1\n") +
                           view("twice", "19 1\n19 2\n20 3\n") + view("vectors", "19 1 2 3\n20 4 5 6\n", 3) +
                           view("h", "19 7\n20 7\n") + view("region", "19 7\n20 7\n");
  const TemporaryFolder folder;
  const std::string path = folder.path() / "views.msh";
  replace_file(path, text);
  TriangleData data;
  check_same_mesh(read_mesh(path, {}, data), mesh_of_gmsh_text());
  CHECK(data == TriangleData{{"h", {-1, 2.5}}, {"lines too", {1, 2}}});
  replace_file(path,
               std::string(kGmshText) + "$ElementData\n1\n\"h\"\n1\n0\n3\n0\n1\n2\n19 x\n20 1\n$EndElementData\n");
  CHECK(mentions(error_text<InputError>([&] { (void)read_mesh(path, {}, data); }), {"'x'", "number is expected"}));
}

TEST_CASE("regions that are not positive integers keep their exact value in .msh") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  Mesh mesh;
  const std::vector<double> regions = {0, -0.0, 1, 2, 0.1, 1e300, -7, 2147483647, 2147483648.0, 5e-324};
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    for (const Point p : {Point{0, 0}, Point{1, 0}, Point{0, 1}}) mesh.points.push_back({p.x + 2.0 * double(i), p.y});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.regions = regions;
  write_mesh(mesh, path);
  const Mesh read = read_mesh(path);
  check_same_mesh(read, mesh);
  CHECK(std::signbit(read.regions[1]));
}

TEST_CASE("the tag of a group does not depend on the other groups, nor on their order") {
  CHECK(group_tags({1, 0, 7}) == std::vector<std::int32_t>{1, kTagOfZero, 7});
  CHECK(group_tags({0}) == std::vector<std::int32_t>{kTagOfZero});
  CHECK(group_tags({3, 0}) == std::vector<std::int32_t>{3, kTagOfZero});
  CHECK(group_tags({0.5, -1, 0, 2, -0.0}) ==
        std::vector<std::int32_t>{kTagOfZero + 3, kTagOfZero + 1, kTagOfZero, 2, kTagOfZero + 2});
  CHECK(group_tags({-1, 2, -0.0, 0.5, 0}) ==
        std::vector<std::int32_t>{kTagOfZero + 1, 2, kTagOfZero + 2, kTagOfZero + 3, kTagOfZero});
  // A marker that is the tag of 0 keeps it where there is no 0.
  CHECK(group_tags({kTagOfZero, 5}) == std::vector<std::int32_t>{kTagOfZero, 5});
  CHECK(group_tags({kTagOfZero, 0, kTagOfZero + 1}) ==
        std::vector<std::int32_t>{kTagOfZero + 2, kTagOfZero, kTagOfZero + 1});
  CHECK(group_tags({INT32_MAX, 1e300, -5}) == std::vector<std::int32_t>{INT32_MAX, kTagOfZero + 2, kTagOfZero + 1});
}

TEST_CASE("marker 0 has the same tag in every .msh") {
  const TemporaryFolder folder;
  for (const std::int32_t other : {1, 2, 3, 7}) {
    Mesh mesh;
    mesh.points = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    mesh.edges = {{0, 1, other}, {1, 2, 0}, {2, 0, other}};
    const std::string path = folder.path() / "mesh.msh";
    write_mesh(mesh, path);
    CHECK(file_bytes(path).find("1 1000000 \"marker 0\"\n") != std::string::npos);
    check_same_mesh(read_mesh(path), mesh);
  }
}

TEST_CASE("an ASCII .msh of Gmsh gives markers and regions by the tags of its groups") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  replace_file(path, kGmshText);
  check_same_mesh(read_mesh(path), mesh_of_gmsh_text());
  replace_file(path, std::string("$Comments\nmade by hand\n$EndComments\n") + kGmshText +
                         "$Periodic\n1\n0 1 2\n0\n$EndPeriodic\n");
  CHECK_THROWS_AS((void)read_mesh(path), InputError);  // $MeshFormat has to come first
  replace_file(path, std::string(kGmshText) + "$Periodic\n1\n0 1 2\n0\n$EndPeriodic\n");
  check_same_mesh(read_mesh(path), mesh_of_gmsh_text());
}

TEST_CASE("groups in .msh have the names of markers and regions, whose exact values are kept beside where needed") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  Mesh mesh = mesh_of_gmsh_text();
  mesh.edges[0].marker = -3;
  mesh.regions = {3, 0.5};
  mesh.names = {{{-3, "shore"}}, {{3, "fluid"}, {0.5, "7"}}};
  write_mesh(mesh, path, {.ascii = true});
  const std::string text = file_bytes(path);
  CHECK(text.find("1 1000001 \"shore\"\n") != std::string::npos);
  CHECK(text.find("2 3 \"fluid\"\n") != std::string::npos);
  CHECK(text.find("$DriftmeshValues\n2\n1 1000001 -3\n2 1000001 0.5\n$EndDriftmeshValues\n") != std::string::npos);
  check_same_mesh(read_mesh(path), mesh);

  const auto refused = [&](const std::string& what, const std::string& instead) {
    std::string damaged = text;
    damaged.replace(damaged.find(what), what.size(), instead);
    replace_file(path, damaged);
    CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("DriftmeshValues"), InputError);
  };
  refused("1 1000001 -3\n", "1 1000001 -3.5\n");
  refused("1 1000001 -3\n", "1 1000001 3e9\n");
  refused("1 1000001 -3\n2 ", "1 1000001 -3\n1 ");
  refused("$DriftmeshValues\n2", "$DriftmeshValues\n1");
}

TEST_CASE("a clockwise mesh is reversed as a whole; a single inverted triangle stays for a check to find") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  const std::string one = replaced(kGmshText, "20 1 10 12", "20 1 12 10");
  replace_file(path, replaced(one, "10\n12\n1 1 0\n0 1 0", "10\n12\n1 1 0\n0 0.5 0"));
  CHECK(read_mesh(path).triangles[1] == std::array{0, 3, 2});
  replace_file(path, replaced(one, "19 1 5 10", "19 1 10 5"));
  CHECK(read_mesh(path).triangles == std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("the plane of a .msh may have any height") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  std::string lifted = replaced(kGmshText, "\n0 0 0\n", "\n0 0 -2.5\n");
  lifted = replaced(lifted, "1 0 0 0.5\n", "1 0 -2.5 0.5\n");
  lifted = replaced(lifted, "1 1 0\n0 1 0\n", "1 1 -2.5\n0 1 -2.5\n");
  replace_file(path, lifted);
  check_same_mesh(read_mesh(path), mesh_of_gmsh_text());
}

TEST_CASE("a .msh that cannot be read is rejected with a next step") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  const auto refused = [&](const char* from, const char* to) {
    return message_of(path, replaced(kGmshText, from, to));
  };
  CHECK(refused("4.1 0 8", "2.2 0 8").find("version 4.1; convert it: gmsh") != std::string::npos);
  CHECK(refused("2 1 2 2\n", "2 1 9 2\n").find("type 9, neither triangles (2) nor lines (1); save the mesh in first") !=
        std::string::npos);
  CHECK(refused("2 1 2 2\n", "2 1 3 2\n").find("type 3") != std::string::npos);
  CHECK(refused("1 1 0\n", "1 1 0.5\n").find("not planar") != std::string::npos);
  CHECK(refused("19 1 5 10", "19 1 5 11").find("a triangle names node 11, which does not exist") != std::string::npos);
  CHECK(refused("10\n12\n", "10\n10\n").find("two nodes of tag 10") != std::string::npos);
  CHECK(refused("1 1 0\n", "1 x1 0\n").find("holds 'x1' where a number is expected") != std::string::npos);
  CHECK(refused("1 1 0\n", "1 nan 0\n").find("is not finite") != std::string::npos);
  CHECK(refused("$Nodes", "$Knots").find("ends before $EndKnots") != std::string::npos);
  CHECK(message_of(path, "").find("has no $MeshFormat") != std::string::npos);
}

TEST_CASE("a .msh of text that is cut off or damaged is refused, or is a mesh") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  const auto read = [&] { (void)read_mesh(path); };
  replace_file(path, kGmshText);
  const DamageCount cut = read_truncated(path, read);
  CHECK(cut.accepted <= 1);  // without the last end of line
  CHECK(cut.refused > 400);
  CHECK(read_flipped(path, 3000, 6, read).refused > 1000);
}
