#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "geometry/predicates.hpp"
#include "verify/across_check.hpp"
#include "verify/edge_check.hpp"
#include "verify/number_runs.hpp"
#include "verify/piece_check.hpp"
#include "verify/polygons_check.hpp"
#include "verify/quality.hpp"
#include "verify/size_check.hpp"
#include "verify/step_check.hpp"
#include "verify/verify.hpp"

// What parts of the verifier count and measure, each by itself, where the answer is known.

using namespace driftmesh;

namespace {

/// A strip of squares, each cut along a diagonal.
Mesh grid(std::int32_t columns, std::int32_t rows) {
  Mesh mesh;
  for (std::int32_t y = 0; y <= rows; ++y)
    for (std::int32_t x = 0; x <= columns; ++x)
      mesh.points.push_back({static_cast<double>(x) / rows, static_cast<double>(y) / rows});
  const std::int32_t width = columns + 1;
  for (std::int32_t y = 0; y < rows; ++y)
    for (std::int32_t x = 0; x < columns; ++x) {
      const std::int32_t a = y * width + x;
      mesh.triangles.push_back({a, a + 1, a + width + 1});
      mesh.triangles.push_back({a, a + width + 1, a + width});
    }
  return mesh;
}

/// Two squares joined at a neck between two corners, which one edge connects.
Mesh hourglass() {
  Mesh mesh;
  mesh.points = {{0, 0}, {2, 0.95}, {4, 0}, {4, 2}, {2, 1.05}, {0, 2}, {1, 1}, {3, 1}};
  mesh.triangles = {{0, 1, 6}, {1, 4, 6}, {4, 5, 6}, {5, 0, 6}, {1, 7, 4}, {1, 2, 7}, {2, 3, 7}, {3, 4, 7}};
  return mesh;
}

AcrossReport across(const Mesh& mesh, int layers, std::size_t& flaws) {
  Findings findings(10);
  const AcrossReport report = check_across(mesh, {}, {.layers = layers, .narrowest = 0}, findings);
  flaws = findings.count(Flaw::kFewAcross);
  return report;
}

}  // namespace

TEST_CASE("a channel has as many layers as rows") {
  for (const std::int32_t rows : {1, 2, 3, 5}) {
    CAPTURE(rows);
    std::size_t flaws = 0;
    CHECK(across(grid(8 * rows, rows), rows, flaws).fewest == rows);
    CHECK(flaws == 0);
    const AcrossReport report = across(grid(8 * rows, rows), rows + 1, flaws);
    CHECK(report.fewest == rows);
    CHECK(report.crossings > 0);
    CHECK(flaws == report.crossings);
  }
}

TEST_CASE("a neck between two corners is crossed by the edge between them") {
  std::size_t flaws = 0;
  const AcrossReport report = across(hourglass(), 3, flaws);
  CHECK(report.crossings > 0);
  CHECK(report.fewest == 1);
  CHECK(flaws > 0);
  CHECK(report.on_boundary == 0);
}

TEST_CASE("the fewest layers count, wherever they are") {
  for (const bool last : {false, true}) {  // a single layer before or behind a part of three
    Mesh mesh = grid(24, 3);
    for (Point& p : mesh.points) p.x += 10;
    Mesh thin = grid(8, 1);
    if (last) std::swap(mesh, thin);
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), thin.points.begin(), thin.points.end());
    for (const auto& [a, b, c] : thin.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    std::size_t flaws = 0;
    CHECK(across(mesh, 3, flaws).fewest == 1);
  }
}

TEST_CASE("channels are checked in spite of small angles and large areas, and of no other flaw") {
  Mesh mesh = grid(24, 2);
  VerifyOptions options;
  options.across.layers = 3;
  const auto expect = [&](Flaw other) {
    const VerifyReport report = verify(mesh, options);
    CHECK(report.findings.count(other) > 0);
    CHECK(report.findings.count(Flaw::kFewAcross) > 0);
    CHECK(report.findings.total() == report.findings.count(other) + report.findings.count(Flaw::kFewAcross));
    CHECK(report.across.fewest == 2);
  };
  options.min_angle = 46;
  expect(Flaw::kSmallAngle);
  options.min_angle = 0;
  options.plain.area = 0.124;  // all have 1/8
  expect(Flaw::kLargeArea);
  mesh.triangles.push_back(mesh.triangles[0]);
  CHECK(verify(mesh, options).across.crossings == 0);
}

TEST_CASE("extremes name their triangles, in whatever order these are") {
  const std::array<std::array<Point, 3>, 4> shapes{{{Point{0, 0}, {1, 0}, {1, 1}},
                                                    {Point{0, 0}, {4, 0}, {4, 1}},    // the smallest angle
                                                    {Point{0, 0}, {2, 0}, {1, 0.5}},  // the largest
                                                    {Point{0, 0}, {6, 0}, {3, 5}}}};  // the largest area
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  do {
    Mesh mesh;
    for (const std::size_t shape : order) {
      const auto first = static_cast<std::int32_t>(mesh.points.size());
      mesh.points.insert(mesh.points.end(), shapes[shape].begin(), shapes[shape].end());
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const auto place = [&](std::size_t shape) { return std::ranges::find(order, shape) - order.begin(); };
    const Quality quality = measure(NamedMesh(mesh), {}, 1).quality();
    CHECK(quality.smallest_angle_triangle == place(1));
    CHECK(quality.largest_angle_triangle == place(2));
    CHECK(quality.largest_area_triangle == place(3));
    CHECK(quality.smallest_angle == doctest::Approx(std::atan2(1, 4) * 180 / std::numbers::pi));
    CHECK(quality.largest_angle == doctest::Approx(2 * std::atan2(1, 0.5) * 180 / std::numbers::pi));
    CHECK(quality.largest_area == 15);
    CHECK(quality.smallest_area == 0.5);
  } while (std::ranges::next_permutation(order).found);
}

TEST_CASE("a triangle is excused where doubles have nothing between its corners, and nowhere else") {
  // One with legs of this length amid a large one: its area is too large, as are those of the six triangles around it.
  const auto excused = [](double place, double leg) {
    Mesh mesh;
    const double middle = 1.25 * place;
    mesh.points = {{place, place},   {1.75 * place, place},  {place, 1.75 * place},
                   {middle, middle}, {middle + leg, middle}, {middle, middle + leg}};
    mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 5, 4}, {2, 3, 5}, {2, 0, 3}, {0, 4, 3}, {3, 4, 5}};
    VerifyOptions options;
    options.plain.area = 0x1p-110;
    options.check_delaunay = false;
    const VerifyReport report = verify(mesh, options);
    const std::uint64_t count = report.quality.exceptions[ExceptionReason::kNoRoom].count;
    CHECK(report.findings.total() == 7 - count);
    CHECK(report.findings.count(Flaw::kLargeArea) == 7 - count);
    return count;
  };
  CHECK(excused(1, 0x1p-52) == 1);  // the spacing of doubles from 1 to 2
  CHECK(excused(1, 0x1p-51) == 0);
  CHECK(excused(2, 0x1p-51) == 1);
  CHECK(excused(2, 0x1p-50) == 0);
}

TEST_CASE("points of a piece that have the same number are left to the check of the whole") {
  Mesh piece = grid(3, 3);  // four points inside: 5, 6, 9 and 10
  for (std::int64_t n = 0; n < 16; ++n) piece.numbers.push_back(n);
  CHECK(check_piece(NamedMesh(piece, 0), {}).used_inside == 4);
  piece.numbers[10] = 5;
  const PieceReport report = check_piece(NamedMesh(piece, 0), {});
  CHECK(report.used_inside == 2);
  std::vector<std::int64_t> left;
  for (const std::int32_t v : report.frame.marked()) left.push_back(report.frame.mesh.numbers[v]);
  CHECK(left.size() == 14);
  CHECK(std::ranges::count(left, 5) == 2);
}

TEST_CASE("steps that are not allowed are counted, and the worst are listed, worst first") {
  std::mt19937 random(1);
  StepMeasures all;
  std::vector<double> numbers;
  for (int part = 0; part < 30; ++part) {
    StepMeasures one;
    for (int k = 0; k < part % 4; ++k) {
      const double courant = 1 + static_cast<double>(random() % 1000) / 100;
      numbers.push_back(courant);
      one.add({courant, 1, {{courant, std::to_string(courant)}}}, 3);
    }
    all.add(one, 3);
  }
  std::ranges::sort(numbers, std::greater<>());
  CHECK(all.above == numbers.size());
  CHECK(all.greatest == numbers[0]);
  REQUIRE(all.worst.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(all.worst[k].courant == numbers[k]);
}

TEST_CASE("runs of numbers say what the numbers would") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    NumberRuns runs;
    std::multiset<std::int64_t> numbers;
    for (int k = 0; k < 6; ++k) {
      NumberRuns more;
      const auto first = static_cast<std::int64_t>(random() % 20), count = static_cast<std::int64_t>(random() % 9);
      for (std::int64_t n = first; n < first + count; ++n) {
        more.add(n);
        numbers.insert(n);
      }
      runs.append(more);
    }
    runs.sort();
    const std::set<std::int64_t> different(numbers.begin(), numbers.end());
    std::vector<std::int64_t> repeated;
    for (const std::int64_t n : different)
      if (numbers.count(n) > 1) repeated.push_back(n);
    CHECK(runs.count() == static_cast<std::int64_t>(different.size()));
    CHECK(runs.repeated() == repeated);
    CHECK(runs.largest() == (different.empty() ? -1 : *different.rbegin()));
  }
}

TEST_CASE("an edge may miss the Delaunay property by the slack, and interfaces are counted") {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0.5, 0.5}, {0.5, -0.499}};  // the last is 0.001 inside the circle
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  const auto flaws = [&](double slack) {
    EdgeCheck check(NamedMesh(mesh), {.applies = true, .slack = slack}, 10);
    check.check(0, 1, {0, 2}, {1, 3});
    return check.findings().count(Flaw::kNotDelaunay);
  };
  CHECK(flaws(0) == 1);
  CHECK(flaws(0.0009) == 1);
  CHECK(flaws(0.0011) == 0);
  mesh.subdomains = {4, 5};
  for (const std::int32_t other : {0, 1}) {
    mesh.ranks = {0, other};
    EdgeCheck check(NamedMesh(mesh), {}, 10);
    check.check(0, 1, {0, 2}, {1, 3});
    CHECK(check.interfaces().edges == 1);
    CHECK(check.interfaces().not_delaunay == 1);
    CHECK(check.interfaces().between_ranks == static_cast<std::size_t>(other));
    CHECK(check.findings().count(Flaw::kNotDelaunay) == 0);
  }
}

TEST_CASE("a mark asks for lengths in the triangle that it is in, and in no other") {
  static constexpr Point kMark{0.6, 0.3};
  class Marked final : public SizeField {
   public:
    [[nodiscard]] double edge_length(const Point& p) const override { return p == kMark ? 0.01 : 10; }
    void visit_marks(const std::function<void(const Point&)>& visit) const override { visit(kMark); }
  };
  const Marked field;
  const SizeCheck check(field, 0, 1);
  const SizeCheck::Triangle here{Point{0, 0}, Point{1, 0}, Point{1, 1}}, beside{Point{0, 0}, Point{1, 1}, Point{0, 1}};
  REQUIRE(check.find_miss(here, 0.5).has_value());
  CHECK(check.find_miss(here, 0.5)->at == kMark);
  CHECK(check.find_miss(here, 0.5)->length == 0.01);
  CHECK_FALSE(check.find_miss(beside, 0.5).has_value());
}

TEST_CASE("polygons with other regions are other polygons") {
  Pslg one;
  one.points = {{0, 0}, {1, 0}, {1, 1}};
  one.segments = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  one.regions = {{{}, 7, 0}};
  one.polygons = {{.rings = {{0, 1, 2}}, .region = 0}};
  CHECK(same_polygons(one, one));
  Pslg other = one;
  other.regions[0].attribute = 8;
  CHECK_FALSE(same_polygons(one, other));
}

TEST_CASE("a triangle whose area is lost in rounding has no small angle if no angle is asked for") {
  // Its corners are almost on a line, and counterclockwise by less than doubles tell.
  Mesh mesh;
  mesh.points = {{0.1, 0.3}, {2.2700000000000005, 1.23}, {0.24000000000000002, 0.36}, {-0.76, 5.36}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}};
  REQUIRE(orient2d(mesh.points[0], mesh.points[1], mesh.points[2]) > 0);
  VerifyOptions options;
  CHECK(verify(mesh, options).accepted());
  options.min_angle = 0.001;
  CHECK(verify(mesh, options).findings.count(Flaw::kSmallAngle) == 1);
}
