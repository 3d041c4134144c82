#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/pvtu_format.hpp"
#include "mesh/merge_pieces.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// Pieces written by hand: two unit squares side by side that share the points 1, 4 and, halfway, 6.

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

Mesh left_square() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {1, 0.5}};
  mesh.numbers = {0, 1, 3, 4, 6};
  mesh.triangles = {{0, 1, 4}, {0, 4, 2}, {2, 4, 3}};
  mesh.edges = {{0, 1, 5}, {3, 2, 7}, {2, 0, 8}};
  mesh.subdomains = {0, 0, 0};
  mesh.ranks = {0, 0, 0};
  return mesh;
}

Mesh right_square() {
  Mesh mesh;
  mesh.points = {{1, 0}, {2, 0}, {1, 1}, {2, 1}, {1, 0.5}};
  mesh.numbers = {1, 2, 4, 5, 6};
  mesh.triangles = {{0, 1, 4}, {1, 3, 4}, {4, 3, 2}};
  mesh.edges = {{0, 1, 5}, {1, 3, 6}, {3, 2, 7}};
  mesh.subdomains = {1, 1, 1};
  mesh.ranks = {1, 1, 1};
  return mesh;
}

Pslg outline() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 5}, {1, 2, 5}, {2, 3, 6}, {3, 4, 7}, {4, 5, 7}, {5, 0, 8}};
  return pslg;
}

VerifyReport check(const std::vector<Mesh>& pieces) {
  const Pslg input = outline();
  return verify_pieces(pieces, &input, {});
}

void write_two(const std::string& path) {
  write_mesh(left_square(), pvtu_piece_path(path, 0));
  write_mesh(right_square(), pvtu_piece_path(path, 1));
  write_pvtu(path, 2, arrays_of(left_square()));
}

}  // namespace

TEST_CASE("data at triangles of pieces come in the order of the triangles") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "mesh.pvtu").string();
  Mesh left = left_square(), right = right_square();
  left.subdomains = {0, 2, 0};
  right.subdomains = {1, 1, 0};
  write_mesh(left, {{"depth", {1, 2, 3}}, {"own", {7, 7, 7}}}, pvtu_piece_path(path, 0), {});
  write_mesh(right, {{"depth", {4, 5, 6}}}, pvtu_piece_path(path, 1), {});
  write_pvtu(path, 2, arrays_of(left));
  TriangleData data;
  const Mesh mesh = read_mesh(path, {}, data);
  CHECK(mesh.subdomains == std::vector<std::int32_t>{0, 0, 0, 1, 1, 2});
  CHECK(data == TriangleData{{"depth", {1, 3, 6, 4, 5, 2}}});
  CHECK(mesh.triangles == read_mesh(path).triangles);
  CHECK(mesh.triangles[5] == std::array<std::int32_t, 3>{0, 6, 3});
}

TEST_CASE("two pieces that fit are one mesh") {
  const VerifyReport report = check({left_square(), right_square()});
  CHECK(report.accepted());
  CHECK(report.pieces == 2);
  CHECK(report.subdomains == 2);
  CHECK(report.interfaces == 1);
  CHECK(report.interface_edges == 2);
  CHECK(report.rank_interface_edges == 2);
  CHECK(report.points == 7);
}

TEST_CASE("a split point that one side lacks is found") {
  Mesh right = right_square();
  right.points.pop_back();
  right.numbers.pop_back();
  right.triangles = {{0, 1, 3}, {0, 3, 2}};
  right.subdomains.pop_back();
  right.ranks.pop_back();
  const VerifyReport report = check({left_square(), right});
  CHECK(!report.accepted());
  CHECK(report.findings.count(Flaw::kOpenEdge) == 3);
  CHECK(report.findings.count(Flaw::kPiecesDisagree) == 0);
}

TEST_CASE("a coordinate that differs in its last bit is found") {
  Mesh right = right_square();
  right.points[4].y = std::nextafter(0.5, 1);
  const VerifyReport report = check({left_square(), right});
  CHECK(report.findings.count(Flaw::kPiecesDisagree) == 1);
  CHECK(report.findings.messages(Flaw::kPiecesDisagree)[0] ==
        "point 6 has other coordinates in piece 0 than in piece 1");
}

TEST_CASE("other markers and attributes of the same point are found") {
  Mesh left = left_square(), right = right_square();
  for (Mesh* piece : {&left, &right}) {
    piece->point_markers = {1, 1, 1, 1, 1};
    piece->attributes_per_point = 2;
    piece->attributes.assign(10, 0.25);
  }
  CHECK(check({left, right}).findings.count(Flaw::kPiecesDisagree) == 0);
  right.point_markers[2] = 3;
  right.attributes[9] = 0.5;
  const VerifyReport report = check({left, right});
  CHECK(report.findings.count(Flaw::kPiecesDisagree) == 2);
  CHECK(report.findings.messages(Flaw::kPiecesDisagree)[0] == "point 4 has other marker in piece 0 than in piece 1");
  CHECK(report.findings.messages(Flaw::kPiecesDisagree)[1] ==
        "point 6 has other attributes in piece 0 than in piece 1");
}

TEST_CASE("pieces have their names in common, and different ones for a marker are found") {
  Mesh left = left_square(), right = right_square();
  left.names = {{{5, "south"}}, {{1, "west"}}};
  right.names = {{{5, "south"}, {6, "east"}}, {}};
  MergeFaults faults;
  CHECK(merge_pieces(std::vector{left, right}, faults).names == Names{{{5, "south"}, {6, "east"}}, {{1, "west"}}});
  CHECK(faults.count == 0);
  right.names.markers[5] = "north";
  CHECK(merge_pieces(std::vector{left, right}, faults).names.markers.at(5) == "south");
  REQUIRE(faults.count == 1);
  CHECK(faults.first[0] == "pieces have different names, 'south' and 'north'");
}

TEST_CASE("points with different numbers at the same place of an interface are found") {
  Mesh right = right_square();
  right.numbers[4] = 7;
  const VerifyReport report = check({left_square(), right});
  CHECK(report.findings.count(Flaw::kDuplicatePoint) == 1);
  CHECK(report.findings.count(Flaw::kOpenEdge) == 4);
}

TEST_CASE("a missing piece is found") {
  const VerifyReport report = check({left_square(), Mesh{}});
  CHECK(report.findings.messages(Flaw::kPiecesDisagree)[0] ==
        "numbers go up to 6, but all pieces together have 5 points: pieces are missing");
  CHECK(report.findings.count(Flaw::kOpenEdge) == 2);
  Mesh more = left_square();  // with points that no triangle uses: one number is missing, not most of them
  more.points.insert(more.points.end(), {{5, 5}, {6, 6}, {7, 7}});
  more.numbers.insert(more.numbers.end(), {2, 7, 8});
  CHECK(check({more, Mesh{}, left_square()}).findings.messages(Flaw::kPiecesDisagree)[0] == "point 5 is in no piece");
  Mesh far = left_square();
  far.numbers[0] = 700'000'000'000;
  CHECK(check({far, right_square()})
            .findings.messages(Flaw::kPiecesDisagree)[0]
            .starts_with("numbers go up to 700000000000"));
  far.numbers[0] = -1;
  CHECK_THROWS_WITH_AS(check({far, right_square()}), doctest::Contains("number -1"), Error);
  far.numbers.clear();
  CHECK_THROWS_WITH_AS(check({far, right_square()}), doctest::Contains("piece 0 does not say"), Error);
}

TEST_CASE("a duplicate piece is found") {
  const VerifyReport report = check({left_square(), right_square(), right_square()});
  CHECK(report.findings.count(Flaw::kDuplicateTriangle) == 3);
}

TEST_CASE("a number twice in one piece is found") {
  Mesh left = left_square();
  left.numbers[4] = 0;
  CHECK(check({left, right_square()}).findings.messages(Flaw::kPiecesDisagree)[0] == "point 0 is twice in piece 0");
}

TEST_CASE("a subsegment between two pieces is one; with another marker it is two") {
  Mesh left = left_square(), right = right_square();
  left.edges.push_back({1, 4, 9});
  left.edges.push_back({4, 3, 9});
  right.edges.push_back({2, 4, 9});
  right.edges.push_back({0, 4, 9});
  CHECK(verify_pieces(std::vector{left, right}, nullptr, {}).accepted());
  CHECK(verify_pieces(std::vector{left, right}, nullptr, {}).subsegments == 8);
  right.edges.back().marker = 3;
  CHECK(verify_pieces(std::vector{left, right}, nullptr, {}).findings.count(Flaw::kDuplicateSubsegment) == 1);
  left.edges.push_back({4, 3, 9});
  CHECK(verify_pieces(std::vector{left, right}, nullptr, {}).findings.count(Flaw::kDuplicateSubsegment) == 2);
}

TEST_CASE("an edge that is not Delaunay is a flaw inside a subdomain, and only counted between two") {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, 0}, {1, 0.5}, {1, -0.5}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  mesh.edges = {{1, 2, 1}, {2, 0, 1}, {0, 3, 1}, {3, 1, 1}};
  CHECK(verify(mesh, {}).findings.count(Flaw::kNotDelaunay) == 1);
  mesh.subdomains = {4, 4};
  CHECK(verify(mesh, {}).findings.count(Flaw::kNotDelaunay) == 1);
  mesh.subdomains = {4, 9};
  const VerifyReport report = verify(mesh, {});
  CHECK(report.accepted());
  CHECK(report.interface_edges_not_delaunay == 1);
}

TEST_CASE("files of pieces: missing, truncated and damaged ones are named") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "two.pvtu", piece = folder.path() / "two_1.vtu";
  write_two(path);
  MergeFaults faults;
  const std::vector<Mesh> pieces{left_square(), right_square()};
  check_same_mesh(read_mesh(path), merge_pieces(pieces, faults));

  const DamageCount cut = read_truncated(path, [&] { (void)read_mesh(path); });
  CHECK(cut.accepted <= 1);  // the end of the last line
  const DamageCount cut_piece = read_truncated(piece, [&] { (void)read_mesh(path); });
  CHECK(cut_piece.accepted <= static_cast<int>(std::strlen("\n  </AppendedData>\n</VTKFile>\n")));
  (void)read_flipped(path, 300, 5, [&] { (void)read_mesh(path); });
  (void)read_flipped(piece, 1000, 6, [&] { (void)read_mesh(path); });
  std::filesystem::remove(piece);
  CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("two_1.vtu"), Error);
  CHECK_THROWS_WITH_AS(write_mesh(left_square(), path), doctest::Contains("mesh in pieces"), InputError);
}

TEST_CASE("pieces that do not fit together are read for a check, and otherwise rejected") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "two.pvtu";
  write_two(path);
  Mesh right = right_square();
  right.points[4].y = std::nextafter(0.5, 1);
  write_mesh(right, pvtu_piece_path(path, 1));
  CHECK(check(read_pieces(path)).findings.count(Flaw::kPiecesDisagree) == 1);
  CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("point 6 has other coordinates"), InputError);
}
