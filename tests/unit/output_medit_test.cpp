#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "io/medit_format.hpp"
#include "io/mesh_file.hpp"
#include "io/mfem_format.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using testing::error_text;
using testing::mentions;

namespace {

Mesh two_triangles() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.125}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{0, 1, 7}, {1, 2, -2}, {2, 0, 5}, {2, 3, 7}, {3, 0, 7}};
  mesh.point_markers = {7, 0, -2, 1};
  mesh.regions = {0.5, 3};
  mesh.names.markers = {{7, "open sea"}};
  mesh.names.regions = {{0.5, "reef # 2"}};
  return mesh;
}

// As mmg2d and FreeFEM write them: other sections before, between and behind, blanks as they please.
const char* const kForeign =
    "MeshVersionFormatted 2\n\n\nDimension\n3\n# a comment\n\nRequiredVertices\n2\n1\n3\n"
    "Vertices\n4\n0 0 0 0\n 1.  0 0 0\n+1e0\t0.5 0 0 \n0 .125 0. 0\nCorners\n1\n2\n"
    "Triangles 2\n1 2 3 4\n1 3 4 0\nNormals 1 0 0 1\nEdges\n1\n1 2 9\nEnd\n";

}  // namespace

TEST_CASE("a mesh of Medit has numbers from 1, references, and comments that say what tags stand for") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "two.medit.mesh";
  write_mesh(two_triangles(), path);
  CHECK(read_file(path) ==
        "MeshVersionFormatted 2\n# driftmesh marker 7 7 open sea\n# driftmesh region 1000001 0.5 reef # 2\n"
        "# driftmesh region 3 3\n\nDimension 2\n"
        "\nVertices\n4\n0 0 7\n1 0 0\n1 0.5 -2\n0 0.125 1\n"
        "\nEdges\n5\n1 2 7\n2 3 -2\n3 1 5\n3 4 7\n4 1 7\n"
        "\nTriangles\n2\n1 2 3 1000001\n1 3 4 3\n\nEnd\n");
}

TEST_CASE("the first line of a .mesh tells whose format it is, whatever the file is called") {
  const TemporaryFolder folder;
  const std::string medit = folder.path() / "a.medit.mesh", mfem = folder.path() / "b.mesh";
  write_mesh(two_triangles(), medit);
  write_mesh(two_triangles(), mfem);
  CHECK(read_file(mfem).starts_with("MFEM mesh v1.0\n"));
  CHECK(parse_mfem("b", read_file(mfem)).regions == two_triangles().regions);
  const std::string other = folder.path() / "c.mesh";
  write_medit(two_triangles(), other);
  CHECK(read_mesh(other).edges == two_triangles().edges);
  CHECK(read_mesh(other).names.regions == two_triangles().names.regions);
  CHECK(read_mesh(mfem).triangles == two_triangles().triangles);
}

TEST_CASE("meshes of mmg2d, FreeFEM and MFEM are read") {
  const Mesh mesh = parse_medit("foreign.mesh", kForeign);
  CHECK(mesh.points == two_triangles().points);
  CHECK(mesh.triangles == two_triangles().triangles);
  CHECK(mesh.edges == std::vector<Mesh::Edge>{{0, 1, 9}});
  CHECK(mesh.regions == std::vector<double>{4, 0});
  CHECK(mesh.point_markers.empty());

  const Mesh plain =
      parse_mfem("star.mesh",
                 "MFEM mesh v1.0\n\n#\n# Geometry types: TRIANGLE = 2\n#\n\ndimension\n2\n\nelements\n2\n"
                 "1 2 0 1 2\n1 2 0 2 3\n\nboundary\n1\n4 1 0 1\n\nvertices\n4\n2\n0 0\n1 0\n1 0.5\n0 .125\n");
  CHECK(plain.points == two_triangles().points);
  CHECK(plain.triangles == two_triangles().triangles);
  CHECK(plain.edges == std::vector<Mesh::Edge>{{0, 1, 4}});
  CHECK(plain.regions.empty());
}

TEST_CASE("a .mesh with what a planar mesh of triangles cannot have is refused, with its line") {
  const std::vector<std::array<std::string, 3>> cases{
      {"0 .125 0. 0", "0 .125 0.1 0", "foreign.mesh:17: has a point off the plane"},
      {"0 .125 0. 0", "0 .125 -1e-9 0", "foreign.mesh:17: has a point off the plane"},
      {"Triangles 2", "Quadrilaterals 2", "foreign.mesh:21: has Quadrilaterals"},
      {"1 2 3 4\n", "0 2 3 4\n", "names point 0, but numbers begin at 1"},
      {"1 3 4 0", "1 3 5 0", "names vertex 4 of 4"},
      {"Dimension\n3", "Dimension\n4", "has dimension 4"},
      {"Formatted 2", "Formatted 9", "has version 9"},
      {"Edges\n1\n", "Edges\n100000\n", "announces 100000 edges, more than the file can hold"},
      {"Edges\n1\n", "Vertices\n1\n", "has the section Vertices twice"},
      {"\n1 2 9", "\n1 2 x9", "has 'x9' in place of the reference of an edge"},
      {"End\n", "", "ends before End"},
      {"MeshVersion", "Mesh version", "does not begin with MeshVersionFormatted"}};
  for (const auto& [what, instead, message] : cases) {
    std::string text = kForeign;
    text.replace(text.find(what), what.size(), instead);
    CAPTURE(text);
    const std::string error = error_text([&] { (void)parse_medit("foreign.mesh", text); });
    CAPTURE(error);
    CHECK(mentions(error, message));
  }
  const auto mfem = [](const std::string& text) { return error_text([&] { (void)parse_mfem("m.mesh", text); }); };
  CHECK(mentions(mfem("MFEM NURBS mesh v1.0\n"), {"m.mesh:1: does not begin with 'MFEM mesh v1.0'"}));
  CHECK(mentions(mfem("MFEM mesh v1.0\ndimension\n3\n"), {"m.mesh:3: is not planar"}));
  CHECK(mentions(mfem("MFEM mesh v1.0\ndimension 2\nelements\n1\n1 3 0 1 2 3\n"), {"geometry type 3"}));
  CHECK(mentions(mfem("MFEM mesh v1.0\ndimension 2\nelements 0\nboundary 0\nvertices\n4\nnodes\n"), {"curved"}));
}
