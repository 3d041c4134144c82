#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "driftmesh/error.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/triangle_files.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

std::string message_of(const std::string& path) {
  return error_text([&] { (void)read_poly(path); });
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string without(const std::string& part, std::string text) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

std::size_t lines(const std::string& text) {
  return 1 + std::count(text.begin(), text.end(), '\n');
}

const char* const kTriangle =
    "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n"
    "3 0\n1 1 2\n2 2 3\n3 3 1\n"
    "0\n";

}  // namespace

TEST_CASE("a plain .poly") {
  const Pslg pslg = parse_poly("t.poly", kTriangle);
  CHECK(pslg.points == std::vector<Point>{{0, 0}, {1, 0}, {0, 1}});
  CHECK(pslg.segments == std::vector<Pslg::Segment>{{0, 1, 0}, {1, 2, 0}, {2, 0, 0}});
  CHECK(pslg.point_markers.empty());
  CHECK(pslg.attributes.empty());
  CHECK(pslg.holes.empty());
  CHECK(pslg.regions.empty());
  CHECK(pslg.first_number == 1);
}

TEST_CASE(
    "everything that a .poly may contain: comments, tabs, CRLF, numbers from zero, attributes, markers, holes, "
    "regions") {
  const Pslg pslg = parse_poly("t.poly",
                               "\xef\xbb\xbf# a comment\r\n\r\n"
                               "4\t2 2 1   # header\r\n"
                               "0 0 0 1.5 -2 7\r\n"
                               "  1 +1e1 .5\t3 4 -8#glued comment\r\n"
                               "2 10 10 0 0 9 0 # a zero more\r\n"
                               "3 0 1E1 1e-3 1 0\r\n"
                               "2 1\r\n"
                               "0 0 1 5\r\n"
                               "# between\r\n"
                               "1 3 2 6\r\n"
                               "1\r\n0 2 3\r\n"
                               "2\r\n"
                               "0 4 5 17 0.25\r\n"
                               "1 6 7 18");
  CHECK(pslg.first_number == 0);
  CHECK(pslg.points == std::vector<Point>{{0, 0}, {10, .5}, {10, 10}, {0, 10}});
  CHECK(pslg.attributes_per_point == 2);
  CHECK(pslg.attributes == std::vector<double>{1.5, -2, 3, 4, 0, 0, 1e-3, 1});
  CHECK(pslg.point_markers == std::vector<std::int32_t>{7, -8, 9, 0});
  CHECK(pslg.segments == std::vector<Pslg::Segment>{{0, 1, 5}, {3, 2, 6}});
  CHECK(pslg.holes == std::vector<Point>{{2, 3}});
  CHECK(pslg.regions == std::vector<Pslg::Region>{{{4, 5}, 17, 0.25}, {{6, 7}, 18, 18}});
}

TEST_CASE("a .poly without vertices takes them from the .node file; a .node file is read as points") {
  const TemporaryFolder folder;
  write_text(folder.path() / "box.1.node", "3 2 0 1\n0 0 0 1\n1 1 0 2\n2 0 1 3\n");
  write_text(folder.path() / "box.1.poly", "0 2 0 1\n1 1\n0 1 2 4\n0\n");
  const Pslg poly = read_poly((folder.path() / "box.1.poly").string());
  CHECK(poly.points == std::vector<Point>{{0, 0}, {1, 0}, {0, 1}});
  CHECK(poly.point_markers == std::vector<std::int32_t>{1, 2, 3});
  CHECK(poly.segments == std::vector<Pslg::Segment>{{1, 2, 4}});
  CHECK(poly.first_number == 0);
  const Pslg node = read_poly((folder.path() / "box.1.node").string());
  CHECK(node.points == poly.points);
  CHECK(node.segments.empty());
}

TEST_CASE("a number has one sign") {
  for (const char* const text : {"3 2\n1 0 0\n2 +-1 0\n3 0 1\n0\n0\n", "3 2 0 1\n1 0 0 1\n2 1 0 +-7\n3 0 1 1\n0\n0\n"})
    CHECK_THROWS_WITH_AS(static_cast<void>(parse_poly("t.poly", text)), doctest::Contains("t.poly:3: "), InputError);
}

TEST_CASE("files that cannot be opened are named") {
  CHECK(message_of("/no/such.poly") == "/no/such.poly: cannot open: No such file or directory");
}

TEST_CASE("fields and records beyond those announced are refused with their line") {
  const std::string points = "3 2\n1 0 0\n2 1 0\n3 0 1\n";
  const auto refused = [](const std::string& text) {
    try {
      (void)parse_poly("t.poly", text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refused(points + "1 0\n1 1 2 0\n0\n") == "accepted");
  CHECK(refused(points + "1 0\n1 1 2 5\n0\n") ==
        "t.poly:6: the line has more fields than announced, from '5' on; remove them, or correct the number of columns "
        "in the header");
  CHECK(refused(points + "1 1\n1 1 2 5\n0\n1\n1 .1 .1 2\n2 .2 .2 3\n") ==
        "t.poly:10: there are more records than announced; correct the number in the header, or remove them");
  CHECK_THROWS_WITH_AS(
      (void)parse_area("m.area", "1\n1 0.25\n2 -1\n", 1),
      "m.area:3: there are more records than announced; correct the number in the header, or remove them", InputError);
}

TEST_CASE(".ele with 3 or 6 nodes and attributes, and .area") {
  const NodeTable nodes = parse_node("m.node", "6 2\n1 0 0\n2 1 0\n3 0 1\n4 .5 .5\n5 0 .5\n6 .5 0\n");
  const EleTable three = parse_ele("m.ele", "2 3 1\n1 1 2 3 0.5\n2 4 5 6 -1\n", nodes);
  CHECK(three.triangles == std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {3, 4, 5}});
  CHECK(three.attributes == std::vector<double>{0.5, -1});
  const EleTable six = parse_ele("m.ele", "1 6 0\n1 1 2 3 4 5 6\n", nodes);
  CHECK(six.triangles == std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}});
  CHECK(parse_area("m.area", "2\n1 0.25\n2 -1\n", 2) == std::vector<double>{0.25, -1});
  CHECK_THROWS_WITH_AS((void)parse_ele("m.ele", "1 3 0\n1 1 2 7\n", nodes),
                       "m.ele:2: vertex 7 does not exist; vertices are numbered 1 to 6", InputError);
  CHECK_THROWS_WITH_AS((void)parse_ele("m.ele", "1 4 0\n1 1 2 3 4\n", nodes),
                       "m.ele:1: triangles have 3 or 6 nodes; correct the second field", InputError);
  CHECK_THROWS_AS((void)parse_area("m.area", "3\n1 1\n2 1\n3 1\n", 2), InputError);
  CHECK_THROWS_AS((void)parse_ele("m.ele", "1999999999 3 0\n1 1 2 3\n", nodes), InputError);
}

TEST_CASE("every malformed file gets the right message") {
  const std::string folder = DRIFTMESH_SOURCE_DIR "/tests/regression/input/";
  struct Expected {
    const char* file;
    const char* message;  // without folder and name
  };
  const Expected cases[] = {
      {"empty", ".poly:1: the file ends where the number of vertices is expected; the file has no data"},
      {"only_comments", ".poly:4: the file ends where the number of vertices is expected; the file has no data"},
      {"count_bomb",
       ".poly:1: announces 2000000000 vertices, but the rest of the file has room for 1 at most; correct the "
       "number, or the file is truncated"},
      {"count_too_large",
       ".poly:1: the number of vertices '4000000000' is too large or too small; use a number of moderate "
       "size"},
      {"count_negative", ".poly:1: the number of vertices is -3; expected 0 to 2147483647"},
      {"count_not_integer", ".poly:1: the number of vertices is '3.5', which is not a whole number; correct the field"},
      {"three_dimensions", ".poly:1: the dimension is not 2; only two-dimensional input can be meshed"},
      {"attribute_bomb", ".poly:1: the number of attributes is 2000000; expected 0 to 1000"},
      {"nan_coordinate", ".poly:3: x is not finite; replace NaN and infinity by numbers or remove the record"},
      {"infinite_coordinate", ".poly:3: y is not finite; replace NaN and infinity by numbers or remove the record"},
      {"huge_coordinate",
       ".poly:3: x is outside the range of coordinates; scale the input: magnitudes up to 1.7e72 are supported"},
      {"overflowing_coordinate", ".poly:3: x '1e400' is too large or too small; use a number of moderate size"},
      {"text_coordinate", ".poly:3: x is '1,5', which is not a number; correct the field"},
      {"missing_coordinate",
       ".poly:3: y is missing; add it or correct the number of columns that the header announces"},
      {"missing_attribute",
       ".poly:3: an attribute is missing; add it or correct the number of columns that the header announces"},
      {"missing_marker",
       ".poly:3: the boundary marker is missing; add it or correct the number of columns that the header "
       "announces"},
      {"first_number_two", ".poly:2: the first vertex has number 2; number vertices from 0 or from 1"},
      {"duplicate_number", ".poly:4: vertex number 2 appears twice; vertices are numbered consecutively and 3 is next"},
      {"out_of_order",
       ".poly:3: vertex number 3 is out of order; vertices are numbered consecutively and 2 is next\n"
       ".poly:4: vertex number 2 appears twice; vertices are numbered consecutively and 3 is next"},
      {"vertex_out_of_range", ".poly:8: vertex 4 does not exist; vertices are numbered 1 to 3"},
      {"vertex_zero_of_one_based", ".poly:6: vertex 0 does not exist; vertices are numbered 1 to 3"},
      {"vertex_not_integer", ".poly:6: a vertex number is '2.5', which is not a whole number; correct the field"},
      {"truncated_in_points",
       ".poly:4: the file ends after 3 of 4 vertices; it may be truncated, or the number in the header is "
       "wrong"},
      {"truncated_before_segments",
       ".poly:5: the file ends where the number of segments is expected; add a line '0 0' if there are none"},
      {"truncated_in_segments",
       ".poly:9: the file ends after 2 of 3 segments; it may be truncated, or the number in the header is "
       "wrong"},
      {"truncated_before_holes",
       ".poly:9: the file ends where the number of holes is expected; add a line '0' if there are none; the "
       "file may be truncated"},
      {"truncated_in_holes",
       ".poly:9: the file ends after 1 of 2 holes; it may be truncated, or the number in the header is "
       "wrong"},
      {"nan_hole", ".poly:7: x is not finite; replace NaN and infinity by numbers or remove the record"},
      {"region_without_value",
       ".poly:8: the region attribute is missing; add it or correct the number of columns that the header "
       "announces"},
      {"no_node_companion", ".node: cannot open: No such file or directory"},
      {"zero_vertices_in_node", ".node: has no vertices; there is nothing to mesh"},
      {"binary", ".poly:1: the number of vertices is '??????abc', which is not a whole number; correct the field"},
      {"only_minus", ".poly:2: x is '-', which is not a number; correct the field"},
      {"two_problems",
       ".poly:4: y is 'zero', which is not a number; correct the field\n"
       ".poly:6: vertex 9 does not exist; vertices are numbered 1 to 3"},
  };
  for (const Expected& expected : cases) {
    CAPTURE(expected.file);
    const std::string message = message_of(folder + expected.file + ".poly");
    CHECK(without(folder + expected.file, message) == expected.message);
  }
}

TEST_CASE("the first ten problems are reported together") {
  const std::string message = message_of(DRIFTMESH_SOURCE_DIR "/tests/regression/input/ten_problems.poly");
  CHECK(lines(message) == 11);
  CHECK(message.find("ten_problems.poly:11: x is 'x', which is not a number; correct the field") != std::string::npos);
  CHECK(message.find("ten_problems.poly:12:") == std::string::npos);
}
