#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/su2_format.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

/// A quadrilateral of two triangles with a segment between them.
Mesh quadrilateral() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{0, 1, 7}, {1, 2, -2}, {2, 0, 5}, {2, 3, 7}, {3, 0, 7}};
  return mesh;
}

/// What is read back: the boundary, marker by marker.
Mesh boundary_only(Mesh mesh) {
  mesh.edges = {{1, 2, -2}, {0, 1, 7}, {2, 3, 7}, {3, 0, 7}};
  mesh.names.markers.erase(5);
  return mesh;
}

// As other programs write it: comments, blanks, points first, no numbers behind elements, markers by name.
const char* const kFoilText =
    "% a foil\n"
    "NPOIN = 4 4 % and in all zones\n"
    "\t0.0 +0.0\n1e0 0 1\n\n1.0\t1.0 2\n0 1 3\n"
    "NDIME=2\r\nNZONE= 1\nAOA= 2.5\n"
    "NELEM= 2\n5 0 1 2\n5\t0 2 3 1\n"
    "NMARK= 3\n"
    "MARKER_TAG= wall\nMARKER_ELEMS= 2\n3 0 1 0\n3 1 2\n"
    "MARKER_TAG= 1\nMARKER_ELEMS= 1\n3 2 3\n"
    "MARKER_TAG= far_field\nMARKER_ELEMS= 1\n3 3 0\n";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  REQUIRE(text.find(what) != std::string::npos);
  return text.replace(text.find(what), what.size(), instead);
}

}  // namespace

TEST_CASE("a .su2 has triangles, points, and the boundary by its markers, but no segments inside") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.su2";
  const Mesh mesh = quadrilateral();
  write_mesh(mesh, path);
  CHECK(file_bytes(path) ==
        "NDIME= 2\n"
        "NELEM= 2\n5 0 1 2 0\n5 0 2 3 1\n"
        "NPOIN= 4\n0 0 0\n1 0 1\n1 0.5 2\n0 0.1 3\n"
        "NMARK= 2\n"
        "MARKER_TAG= -2\nMARKER_ELEMS= 1\n3 1 2\n"
        "MARKER_TAG= 7\nMARKER_ELEMS= 3\n3 0 1\n3 2 3\n3 3 0\n");
  check_same_mesh(read_mesh(path), boundary_only(mesh));
}

TEST_CASE("markers have their names in a .su2, as one word, and read back whole") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.su2";
  Mesh mesh = quadrilateral();
  mesh.names.markers = {{-2, "in (and) out, 50%"}, {5, "inside"}, {7, "-2"}};
  write_mesh(mesh, path);
  const std::string text = file_bytes(path);
  CHECK(text.starts_with(
      "% driftmesh marker -2 in__and__out__50_ in (and) out, 50%\n% driftmesh marker 7 _-2 -2\nNDIME= 2\n"));
  CHECK(text.find("MARKER_TAG= in__and__out__50_\n") != std::string::npos);
  CHECK(text.find("MARKER_TAG= _-2\n") != std::string::npos);
  check_same_mesh(read_mesh(path), boundary_only(mesh));

  mesh.names.markers = {{-2, "SEND_RECEIVE"}};  // SU2's own word for something else
  write_mesh(mesh, path);
  CHECK(file_bytes(path).find("MARKER_TAG= _SEND_RECEIVE\n") != std::string::npos);
  check_same_mesh(read_mesh(path), boundary_only(mesh));

  mesh.names.markers = {{-2, "a b"}, {7, "a,b"}};  // the same word
  write_mesh(mesh, path);
  CHECK(file_bytes(path).find("MARKER_TAG= a_b_7\n") != std::string::npos);
  check_same_mesh(read_mesh(path), boundary_only(mesh));
}

TEST_CASE("a .su2 of another program is read, and its names get numbers") {
  const Mesh mesh = parse_su2("foil.su2", kFoilText);
  CHECK(mesh.points == std::vector<Point>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  CHECK(mesh.triangles == std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
  CHECK(mesh.edges == std::vector<Mesh::Edge>{{0, 1, 2}, {1, 2, 2}, {2, 3, 1}, {3, 0, 3}});
  CHECK(mesh.names.markers == std::map<std::int32_t, std::string>{{2, "wall"}, {3, "far_field"}});
}

TEST_CASE("a .su2 with a fault is refused with its line") {
  const auto refused = [](const std::string& what, const std::string& instead, const char* says) {
    CAPTURE(instead);
    CHECK_THROWS_WITH_AS((void)parse_su2("foil.su2", with(kFoilText, what, instead)), doctest::Contains(says),
                         InputError);
  };
  refused("NDIME=2", "NDIME=3", "foil.su2:8: is not planar");
  refused("NZONE= 1", "NZONE= 2", "several zones");
  refused("NDIME=2", "AOS=1", "has no NDIME");
  refused("AOA=", "NDIME=", "has NDIME twice");
  refused("AOA= 2.5", "2.5", "'2.5' where a keyword is expected");
  refused("NELEM= 2", "NELEM= 99999", "more than the file can hold");
  refused("NELEM= 2", "NELEM= -1", "more than the file can hold");
  refused("NELEM= 2", "NELEM= 1", "where a keyword is expected");
  refused("5 0 1 2\n", "9 0 1 2 3\n", "foil.su2:12: has an element of type 9");
  refused("5 0 1 2\n", "5 0 1\n", "lacks a point of an element");
  refused("5 0 1 2\n", "5 0 1 2 0 0\n", "more on a line than belongs there");
  refused("5 0 1 2\n", "5 0 1 4\n", "foil.su2");
  refused("1e0 0 1", "1e0 y 1", "has 'y' in place of y");
  refused("1e0 0 1", "1e0 nan 1", "foil.su2");
  refused("NMARK= 3\n", "", "has MARKER_TAG before NMARK");
  refused("NMARK= 3", "NMARK= 4", "announces 4 markers, but has 3");
  refused("TAG= far_field", "TAG= wall", "has the marker wall twice");
  refused("TAG= far_field", "TAG= far field", "not one word");
  refused("TAG= far_field", "TAG= SEND_RECEIVE", "between ranks");
  refused("MARKER_ELEMS= 2\n3 0 1 0\n3 1 2\n", "", "without MARKER_ELEMS");
  refused("MARKER_TAG= wall\n", "", "without a MARKER_TAG");
  refused("% a foil", "% driftmesh marker x wall wall", "comment that is not complete");
  refused("% a foil", "% driftmesh marker 1 wall wall", "two markers of number 1");
}
