#include <doctest/doctest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "pslg/triangle_files.hpp"
#include "support/damage.hpp"
#include "temporary_folder.hpp"

// What random edits of valid files got past the readers, as another mesh than the files declare.

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

using Texts = std::map<std::string, std::string>;

/// In one of the texts, some words in place of others.
struct Edit {
  std::string file;
  std::string from, to;
  std::string message;
};

void check_refused(const std::string& main, const Texts& texts, const std::vector<Edit>& edits) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / main;
  for (const auto& [name, text] : texts) replace_file(folder.path() / name, text);
  CHECK_NOTHROW(static_cast<void>(read_mesh(path)));
  for (const Edit& edit : edits) {
    CAPTURE(edit.to);
    std::string text = texts.at(edit.file);
    const std::size_t place = text.find(edit.from);
    REQUIRE(place != std::string::npos);
    replace_file(folder.path() / edit.file, text.replace(place, edit.from.size(), edit.to));
    CHECK_THROWS_WITH_AS(static_cast<void>(read_mesh(path)), doctest::Contains(edit.message.c_str()), InputError);
    replace_file(folder.path() / edit.file, texts.at(edit.file));
  }
}

std::string fuzz_corpus(const std::string& name) {
  return file_bytes(DRIFTMESH_SOURCE_DIR "/tests/fuzz/corpus/read_mesh/" + name);
}

/// Two triangles of a square, with everything that write_msh adds.
const char* const kMsh = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 5 "marker 5"
2 3 "region 3"
$EndPhysicalNames
$Entities
0 1 1 0
5 0 0 0 1 1 0 1 5 0
1 0 0 0 1 1 0 1 3 1 5
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
2 3 1 3
1 5 1 1
1 1 2
2 1 2 2
2 1 2 3
3 1 3 4
$EndElements
$NodeData
1
"attribute 1"
1
0
3
0
1
4
1 0.5
2 1.5
3 2.5
4 3.5
$EndNodeData
$ElementData
1
"subdomain"
1
0
3
0
1
2
2 0
3 1
$EndElementData
$DriftmeshPointMarkers
2
1 7
3 8
$EndDriftmeshPointMarkers
)";

}  // namespace

TEST_CASE("rows of a mesh in Triangle's files are numbered consecutively, from 0 or from 1") {
  const Texts texts{{"m.node", "3 2\n1 0 0\n2 1 0\n3 0 1\n"},
                    {"m.ele", "2 3 1\n1 1 2 3 5\n2 2 3 1 6\n"},
                    {"m.edge", "3 1\n0 1 2 1\n1 2 3 1\n2 3 1 0\n"}};
  check_refused("m.ele", texts,
                {{"m.ele", "\n2 2", "\n1 2", "m.ele:3: triangle number 1 appears twice; triangles are numbered"},
                 {"m.ele", "\n1 1", "\n2 1", "m.ele:2: the first triangle has number 2; number triangles from 0"},
                 {"m.edge", "\n1 2", "\n2 2", "m.edge:3: edge number 2 is out of order; edges are numbered"},
                 {"m.edge", "\n0 1", "\nx 1", "m.edge:2: the edge number is 'x'"}});
  Texts with_segments = texts;
  with_segments["m.poly"] = "0 2\n2 1\n1 1 2 1\n2 2 3 1\n0\n";
  check_refused("m.node", with_segments, {{"m.poly", "\n2 2", "\n3 2", "m.poly:4: edge number 3 is out of order"}});
  CHECK_THROWS_WITH_AS(static_cast<void>(parse_area("m.area", "2\n2 0.5\n1 0.25\n", 2)),
                       doctest::Contains("m.area:2: the first triangle has number 2"), InputError);
}

TEST_CASE("a .poly next to a mesh is no input if its vertices are broken") {
  check_refused(
      "m.ele",
      {{"m.node", "3 2\n1 0 0\n2 1 0\n3 0 1\n"}, {"m.ele", "1\n1 1 2 3\n"}, {"m.poly", "0 2\n1 1\n1 1 2 1\n0\n"}},
      {{"m.poly", "0 2\n1 1\n", "1 2\n1 1\n", "m.poly:2: y is missing"}});
}

TEST_CASE("a .msh says everything once") {
  const auto in_msh = [](const char* from, const char* to, const char* message) {
    return Edit{"m.msh", from, to, message};
  };
  check_refused(
      "m.msh", {{"m.msh", kMsh}},
      {in_msh("3 1 3 4", "2 1 3 4", "has two elements of tag 2"),
       in_msh("2 1 2 3", "1 1 2 3", "has two elements of tag 1"),
       in_msh("1 0 0 0 1 1 0 1 3 1 5\n", "1 0 0 0 1 1 0 1 3 1 5\n1 0 0 0 1 1 0 1 5 0\n", "more in $Entities"),
       in_msh("0 1 1 0\n5 0 0 0 1 1 0 1 5 0\n", "0 1 2 0\n5 0 0 0 1 1 0 1 5 0\n1 0 0 0 1 1 0 0 0\n",
              "has two entities of dimension 2 and tag 1"),
       in_msh("2 3 \"region 3\"", "1 5 \"marker 6\"", "has two physical groups of dimension 1 and tag 5"),
       in_msh("2 1.5", "1 1.5", "has two values of attribute 1 at node 1"),
       in_msh("3 1\n$EndElementData", "2 1\n$EndElementData", "has two values in its view 'subdomain' for element 2"),
       in_msh("3 8", "1 8", "has two point markers of node 1")});
}

TEST_CASE("views in a .msh are of its elements, and complete") {
  const auto in_msh = [](const char* from, const char* to, const char* message) {
    return Edit{"m.msh", from, to, message};
  };
  check_refused(
      "m.msh", {{"m.msh", kMsh}},
      {in_msh("3 1\n$EndElementData", "9 1\n$EndElementData", "for element 9, which does not exist"),
       in_msh("3 1\n$EndElementData", "1 1\n$EndElementData", "has no value in its view 'subdomain' for some"),
       in_msh("3 1\n$EndElementData", "3 1.5\n$EndElementData", "is not a whole number from 0 on"),
       in_msh("\"attribute 1\"", "\"attribute 2\"", "has the view \"attribute 2\" in place of \"attribute 1\""),
       in_msh("3\n0\n1\n4\n1 0.5", "3\n0\n2\n4\n1 0.5", "with other than one component")});
}

TEST_CASE("a .msh has nothing between its sections, and their titles are exact") {
  const auto in_msh = [](const char* from, const char* to, const char* message) {
    return Edit{"m.msh", from, to, message};
  };
  check_refused("m.msh", {{"m.msh", kMsh}},
                {in_msh("$Entities", "Entities", "m.msh:9: has something between its sections"),
                 in_msh("$EndNodes", "$EndNodesx", "more in $Nodes"),
                 in_msh("4.1 0 8", "4.1 2 8", "is neither ASCII (0) nor binary (1)")});
}

TEST_CASE("the elements of a .vtu are closed in turn and lie where they belong") {
  const auto in_vtu = [](const char* from, const char* to, const char* message) {
    return Edit{"m.vtu", from, to, message};
  };
  check_refused(
      "m.vtu", {{"m.vtu", fuzz_corpus("ascii.vtu")}},
      {in_vtu("</PointData>", "</PointDate>", "</PointDate> does not close the element that was opened last"),
       in_vtu("</PointData>", "", "</Piece> does not close"),
       in_vtu("<PointData>", "<PointData> x", "m.vtu:12: has text between its elements"),
       in_vtu("type=\"Int32\" Name=\"marker\"", "type=\"Int32\" Name=\"x\" Name=\"marker\"", "Name is given twice"),
       in_vtu("1 1 2 3\n", "1 1 <!-- --> 2 3\n", "a text is divided by a comment"),
       in_vtu("<Cells>", "<Celle>", "</Cells> does not close")});
  check_refused("m.vtu", {{"m.vtu", fuzz_corpus("piece.vtu")}},
                {in_vtu("<DataArray type=\"Int32\" Name=\"marker\"", "DataArray type=\"Int32\" Name=\"marker\"",
                        "has text between its elements"),
                 in_vtu("  </UnstructuredGrid>\n", "", "has <AppendedData> inside of its grid"),
                 in_vtu("   _", "   x_", "has no '_' at the start of its data")});
}

TEST_CASE("a .pvtu names each piece once, in its grid") {
  const auto array = [](const std::string& name, const std::string& type, const std::string& values) {
    return "<DataArray Name=\"" + name + "\" type=\"" + type + "\"" +
           (name == "Points" ? " NumberOfComponents=\"3\">" : ">") + values + "</DataArray>\n";
  };
  const std::string piece =
      "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">\n<PointData>" +
      array("global_number", "Int64", "0 1 2") + "</PointData>\n<Points>" +
      array("Points", "Float64", "0 0 0 1 0 0 0 1 0") + "</Points>\n<Cells>" + array("connectivity", "Int32", "0 1 2") +
      array("offsets", "Int32", "3") + array("types", "UInt8", "5") +
      "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  const std::string pvtu =
      "<VTKFile type=\"PUnstructuredGrid\">\n<PUnstructuredGrid>\n<Piece Source=\"m_0.vtu\"/>\n"
      "</PUnstructuredGrid>\n</VTKFile>\n";
  check_refused(
      "m.pvtu", {{"m.pvtu", pvtu}, {"m_0.vtu", piece}},
      {{"m.pvtu", "</PUnst", "<Piece Source=\"m_0.vtu\"/>\n</PUnst", "m.pvtu:4: names the piece m_0.vtu twice"},
       {"m.pvtu", "<Piece Source=\"m_0.vtu\"/>", "<PCells><Piece Source=\"m_0.vtu\"/></PCells>", "names no pieces"},
       {"m.pvtu", "<Piece", "Piece", "m.pvtu:4: has text between its elements"},
       {"m.pvtu", "<VTK", "<x/><VTK", "there is a second root"}});
}

TEST_CASE("a damaged file neither controls the terminal nor fills it") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "m.msh";
  replace_file(path, "$MeshFormat\n\x1b[31m4.1 0 8\n");
  CHECK_THROWS_WITH_AS(static_cast<void>(read_mesh(path)), doctest::Contains("holds '?[31m4.1'"), InputError);
  const std::string vtu = folder.path() / "m.vtu";
  std::string text = fuzz_corpus("ascii.vtu");
  replace_file(vtu, text.replace(text.find("format=\"ascii"), 8, "format=\"" + std::string(5000, 'x')));
  try {
    static_cast<void>(read_mesh(vtu));
    CHECK(false);
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).size() < 1500);
    CHECK(std::string(error.what()).find("xxx...; save it as a .vtu") != std::string::npos);
  }
}
