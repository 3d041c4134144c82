#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "damaged_grid.hpp"
#include "driftmesh/id_vector.hpp"
#include "mesh/merge_pieces.hpp"
#include "verify/number_runs.hpp"

// A mesh is found to have the same flaws in one piece and in several, however it is cut up: at one extreme every vertex
// is inside a piece, at the other all are on rims, where other code looks at them.

using namespace driftmesh;
using namespace driftmesh::testing;
using oracles::GridCase;

namespace {

/// The pieces of a mesh, given the piece of each triangle. An unused point is in some piece; a subsegment is in those
/// that have a triangle with both of its ends, or in some piece if none has.
std::vector<Mesh> cut(const Mesh& whole, std::size_t count, const std::function<std::size_t(std::size_t)>& piece_of,
                      std::mt19937& random) {
  std::vector<Mesh> pieces(count);
  std::vector<std::map<std::int32_t, std::int32_t>> local(count);
  const auto take = [&](std::size_t k, std::int32_t v) {
    const auto [entry, added] = local[k].try_emplace(v, static_cast<std::int32_t>(pieces[k].points.size()));
    if (!added) return entry->second;
    pieces[k].points.push_back(whole.points[v]);
    pieces[k].point_markers.push_back(whole.point_markers[v]);
    pieces[k].numbers.push_back(v);
    return entry->second;
  };
  for (const std::int32_t v : first_ids<std::int32_t>(whole.points.size()))
    if (random() % 4 == 0)  // points in any order; some pieces also list points that they do not use
      static_cast<void>(take(random() % count, v));
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const std::size_t k = piece_of(t);
    const auto& [a, b, c] = whole.triangles[t];
    pieces[k].triangles.push_back({take(k, a), take(k, b), take(k, c)});
    pieces[k].regions.push_back(whole.regions[t]);
    if (!whole.subdomains.empty()) pieces[k].subdomains.push_back(whole.subdomains[t]);
  }
  for (const std::int32_t v : first_ids<std::int32_t>(whole.points.size()))
    if (std::ranges::none_of(local, [&](const auto& known) { return known.contains(v); }))
      static_cast<void>(take(random() % count, v));
  for (const Mesh::Edge& edge : whole.edges) {
    std::size_t holders = 0;
    for (std::size_t k = 0; k < count; ++k)
      if (local[k].contains(edge.a) && local[k].contains(edge.b) && (holders++ == 0 || random() % 2 == 0))
        pieces[k].edges.push_back({take(k, edge.a), take(k, edge.b), edge.marker});
    const std::size_t any = random() % count;
    if (holders == 0) pieces[any].edges.push_back({take(any, edge.a), take(any, edge.b), edge.marker});
  }
  return pieces;
}

/// Cuts randomly: into strips, or triangle by triangle.
std::vector<Mesh> cut(const Mesh& whole, std::mt19937& random) {
  const std::size_t count = 1 + random() % 5;
  const std::size_t strip = 1 + random() % (1 + whole.triangles.size() / count);
  if (random() % 2 == 0)
    return cut(
        whole, count, [&](std::size_t t) { return t / strip % count; }, random);
  return cut(
      whole, count, [&](std::size_t) { return random() % count; }, random);
}

/// The words of a text in alphabetic order.
std::string sorted_words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::ranges::sort(words);
  std::string sorted;
  for (const std::string& word : words) sorted += word + " ";
  return sorted;
}

/// All messages, sorted, without the numbers of triangles, which differ between a mesh and its pieces, as may which of
/// two triangles is the first.
std::vector<std::string> messages_of(const VerifyReport& report) {
  static const std::regex triangle("triangle [0-9]+( of piece [0-9]+)? ");
  std::vector<std::string> messages;
  for (std::size_t f = 0; f < kFlawCount; ++f)
    for (const auto& message : report.findings.messages(static_cast<Flaw>(f)))
      messages.push_back(std::string(flaw_name(static_cast<Flaw>(f))) + ": " +
                         sorted_words(std::regex_replace(message, triangle, "triangle ")));
  std::ranges::sort(messages);
  return messages;
}

void check_same(const VerifyReport& pieces, const VerifyReport& whole) {
  const std::vector<std::string> of_pieces = messages_of(pieces), of_whole = messages_of(whole);
  std::vector<std::string> only_one;
  std::ranges::set_symmetric_difference(of_pieces, of_whole, std::back_inserter(only_one));
  std::string text;
  for (const std::string& message : only_one) text += message + "\n";
  CHECK(text == "");
  for (std::size_t f = 0; f < kFlawCount; ++f)
    CHECK(pieces.findings.count(static_cast<Flaw>(f)) == whole.findings.count(static_cast<Flaw>(f)));
  CHECK(pieces.points == whole.points);
  CHECK(pieces.unused_points == whole.unused_points);
  CHECK(pieces.triangles == whole.triangles);
  CHECK(pieces.subsegments == whole.subsegments);
  CHECK(pieces.subsegments_listed == whole.subsegments_listed);
  CHECK(pieces.boundary_edges == whole.boundary_edges);
  CHECK(pieces.subdomains == whole.subdomains);
  CHECK(pieces.interfaces == whole.interfaces);
  CHECK(pieces.interface_edges == whole.interface_edges);
  CHECK(pieces.interface_edges_not_delaunay == whole.interface_edges_not_delaunay);
  CHECK(pieces.area == whole.area);
  CHECK(pieces.quality.angles == whole.quality.angles);
  CHECK(pieces.quality.smallest_area == whole.quality.smallest_area);
  CHECK(pieces.quality.exception_count() == whole.quality.exception_count());
}

VerifyOptions all_messages_with(double min_angle, double max_area) {
  VerifyOptions options;
  options.min_angle = min_angle;
  options.plain.area = max_area;
  options.max_listed = 10'000;
  return options;
}

/// Damages a mesh in ways that leave it in one piece: what randomly_damaged does, and its data.
Mesh damaged(std::mt19937& random) {
  Mesh mesh = random() % 8 == 0 ? GridCase().mesh : randomly_damaged(random);
  for (std::size_t left = random() % 3; left > 0; --left) {
    const std::size_t t = random() % mesh.triangles.size(), v = random() % mesh.points.size();
    switch (random() % 5) {
      case 0:
        mesh.regions[t] = 77;
        break;
      case 1:
        mesh.point_markers[v] = 9;
        break;
      case 2:  // a crack
        add_point(mesh, mesh.points[mesh.triangles[t][0]]);
        mesh.triangles[t][0] = static_cast<std::int32_t>(mesh.points.size()) - 1;
        break;
      case 3:
        add_point(mesh, {20, 20});
        break;
      default:
        mesh.edges.clear();
    }
  }
  if (random() % 2 == 0)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      mesh.subdomains.push_back(static_cast<std::int32_t>(t / 30));
  return mesh;
}

}  // namespace

TEST_CASE("random flaws are found in one piece and in several") {
  std::mt19937 random(7);
  const Pslg input = GridCase().input;
  std::size_t accepted = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    const std::vector<Mesh> pieces = cut(damaged(random), random);
    MergeFaults faults;
    const Mesh whole = merge_pieces(pieces, faults);
    REQUIRE(faults.count == 0);
    VerifyOptions options = all_messages_with(round % 2 == 0 ? 46 : 30, 0.51);
    options.threads = 1 + round % 3;
    check_same(verify_pieces(pieces, nullptr, options), verify(whole, options));
    const VerifyReport joined = verify(whole, input, options);
    accepted += joined.accepted() ? 1 : 0;
    // Otherwise a triangle can be part of several regions.
    if (joined.findings.count(Flaw::kEdgeUsedTwice) == 0) check_same(verify_pieces(pieces, &input, options), joined);
  }
  CHECK(accepted < 100);
}

TEST_CASE("random flaws across interfaces are found as in the joined mesh") {
  std::mt19937 random(11);
  const Pslg input = GridCase().input;
  std::size_t contradictions = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    std::vector<Mesh> pieces = cut(GridCase().mesh, random);
    auto points = static_cast<std::int64_t>(GridCase().mesh.points.size());
    bool doubled = false;
    for (std::size_t left = 1 + random() % 2; left > 0; --left) {
      Mesh& piece = pieces[random() % pieces.size()];
      if (piece.triangles.empty()) continue;
      const std::size_t t = random() % piece.triangles.size(), v = random() % piece.points.size();
      switch (random() % 6) {
        case 0:  // one side has a point of its own there; inside copies of a piece, such points would not be listed
          if (!doubled) piece.numbers[v] = points++;
          break;
        case 1:  // as if it were another point
          piece.numbers[v] = static_cast<std::int64_t>(random() % GridCase().mesh.points.size());
          break;
        case 2:
          drop_triangle(piece, t);
          break;
        case 3:  // in two pieces
          pieces.push_back(piece);
          doubled = true;
          break;
        case 4:
          piece.point_markers[v] = 5;
          break;
        default:
          piece.points[v].x += 0x1p-40;
      }
    }
    MergeFaults faults;
    const Mesh whole = merge_pieces(pieces, faults);
    const VerifyOptions options = all_messages_with(30, 0.51);
    const VerifyReport joined = verify(whole, input, options), alone = verify_pieces(pieces, &input, options);
    CHECK(alone.accepted() == (joined.accepted() && faults.count == 0));
    CHECK(alone.findings.count(Flaw::kPiecesDisagree) == faults.count);
    contradictions += faults.count != 0 ? 1 : 0;
    if (faults.count == 0) check_same(alone, joined);
  }
  CHECK(contradictions > 50);
}

TEST_CASE("runs of numbers") {
  NumberRuns numbers, others;
  for (const std::int64_t n : {7, 8, 9, 3, 4}) numbers.add(n);
  CHECK(numbers.runs().size() == 2);
  for (const std::int64_t n : {8, 9, 10, 20}) others.add(n);
  numbers.append(others);
  numbers.append(others);
  numbers.sort();
  CHECK(numbers.repeated() == std::vector<std::int64_t>{8, 9, 10, 20});
  CHECK(numbers.count() == 7);
  CHECK(numbers.largest() == 20);
  CHECK(NumberRuns().largest() == -1);
  CHECK(NumberRuns().repeated().empty());
}

TEST_CASE("more suspects than are kept are found on a second look") {
  // A strip of flat triangles, in three pieces, and two corners of the input that excuse theirs.
  Mesh mesh;
  constexpr std::int32_t kColumns = 20'000;
  for (std::int32_t x = 0; x <= kColumns; ++x)
    for (const double y : {0.0, 0.125}) mesh.points.push_back({static_cast<double>(x), y});
  for (std::int32_t x = 0; x < kColumns; ++x) {
    const std::int32_t a = 2 * x;
    mesh.triangles.insert(mesh.triangles.end(), {{a, a + 2, a + 1}, {a + 1, a + 2, a + 3}});
    mesh.edges.insert(mesh.edges.end(), {{a, a + 2, 1}, {a + 1, a + 3, 1}});
  }
  mesh.edges.insert(mesh.edges.end(), {{0, 1, 1}, {2 * kColumns, 2 * kColumns + 1, 1}});
  mesh.edges.push_back({1, 2, 1});  // an angle of the input
  mesh.point_markers.assign(mesh.points.size(), 0);
  mesh.regions.assign(mesh.triangles.size(), 0);
  std::mt19937 random(3);
  for (const std::size_t size : {30'000, 100'000}) {  // triangles per piece: several or one with too many suspects
    const std::vector<Mesh> pieces = cut(
        mesh, 3, [&](std::size_t t) { return t / size; }, random);
    for (const std::size_t threads : {1, 2}) {
      VerifyOptions options{.min_angle = 20, .plain = {.area = 0.0625}};
      options.threads = threads;
      const VerifyReport report = verify_pieces(pieces, nullptr, options), whole = verify(mesh, options);
      CHECK(report.findings.count(Flaw::kSmallAngle) + report.quality.exception_count() == 2 * kColumns);
      CHECK(report.findings.count(Flaw::kSmallAngle) == whole.findings.count(Flaw::kSmallAngle));
      CHECK(report.quality.exception_count() == whole.quality.exception_count());
      CHECK(report.quality.exception_count() > 0);
      CHECK(report.findings.messages(Flaw::kSmallAngle).size() == 5);
      CHECK(whole.findings.messages(Flaw::kSmallAngle).size() == 5);
    }
  }
}

TEST_CASE("regions are compared only if every piece lists them") {
  const GridCase grid;
  std::mt19937 random(5);
  const std::size_t half = grid.mesh.triangles.size() / 2;
  std::vector<Mesh> pieces = cut(
      grid.mesh, 2, [&](std::size_t t) { return t / half; }, random);
  pieces[0].regions[0] = pieces[1].regions[0] = 77;
  const VerifyReport report = verify_pieces(pieces, &grid.input, {});
  CHECK_ONLY(report, Flaw::kWrongRegion);
  CHECK(report.findings.count(Flaw::kWrongRegion) == 2);
  CHECK(report.regions_listed);
  for (const std::size_t k : {0, 1}) {
    std::vector<Mesh> without = pieces;
    without[k].regions.clear();
    CHECK(verify_pieces(without, &grid.input, {}).accepted());
    CHECK(!verify_pieces(without, &grid.input, {}).regions_listed);
  }
}

TEST_CASE("threads ask a field of sizes at once") {
  const Mesh mesh = GridCase().mesh;
  struct Field final : SizeField {
    double edge_length(const Point& p) const override { return p.x < 6 ? 1 : 3; }
  };
  const Field field;
  std::mt19937 random(3);
  const std::vector<Mesh> pieces = cut(
      mesh, 4, [](std::size_t t) { return t / 60 % 4; }, random);
  VerifyOptions options = all_messages_with(0, 0);
  options.size = &field;
  const VerifyReport alone = verify(mesh, options);
  CHECK(alone.findings.count(Flaw::kLargeArea) == 128);
  for (const std::size_t threads : {1, 2, 3}) {
    options.threads = threads;
    check_same(verify(mesh, options), alone);
    check_same(verify_pieces(pieces, nullptr, options), alone);
  }
}
