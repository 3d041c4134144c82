#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "adapt/fields.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "patch/area.hpp"
#include "patch/outline_change.hpp"
#include "patch/remake.hpp"
#include "unit_squares.hpp"

// Parts of a grid that are made anew: what follows them, and what is reported.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

constexpr Box kMiddle{{5, 5}, {9, 9}};

Mesh large_grid() {
  return unit_squares(14, 14);
}

patch::Remade made_anew(Mesh mesh, const Box& part, double length, std::vector<adapt::Field> fields = {}) {
  patch::Order order{.inside = patch::triangles_in(mesh, part)};
  order.lengths.assign(mesh.points.size(), length);
  return patch::remake(std::move(mesh), std::move(fields), order);
}

double area_at(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const auto at = [&](std::int32_t v) { return mesh.points[static_cast<std::size_t>(v)]; };
  return signed_area(at(a), at(b), at(c));
}

double whole_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += area_at(mesh, t);
  return area;
}

/// A square with so long sides at the origin.
Pslg square_domain(double side) {
  Pslg pslg;
  pslg.points = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  return pslg;
}

/// Values for each corner of each triangle: linear, and another function in each triangle.
adapt::Field tilted_at_corners(const Mesh& mesh, double tilt) {
  adapt::Field field{FieldPlace::kCorners, Transfer::kConserve, 1, {}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::int32_t v : mesh.triangles[t]) {
      const Point& p = mesh.points[static_cast<std::size_t>(v)];
      field.values.push_back(tilt * p.x - p.y + 0.01 * static_cast<double>(t % 7));
    }
  return field;
}

double integral(const Mesh& mesh, const adapt::Field& field) {
  double sum = 0;
  REQUIRE(field.values.size() == 3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) sum += area_at(mesh, t) * field.values[3 * t + i] / 3;
  return sum;
}

}  // namespace

TEST_CASE("several data at a point go along, each with its own values") {
  const Mesh before = large_grid();
  adapt::Field field{FieldPlace::kPoints, Transfer::kInterpolate, 2, {}};
  for (const Point& p : before.points) field.values.insert(field.values.end(), {p.x + 2 * p.y, 3 - p.x});
  for (const double length : {0.5, 3.0}) {
    CAPTURE(length);
    const patch::Remade after = made_anew(before, kMiddle, length, {field});
    CHECK(after.report.gone_points + after.report.new_points > 0);
    const std::vector<double>& values = after.fields[0].values;
    REQUIRE(values.size() == 2 * after.mesh.points.size());
    for (std::size_t v = 0; v < after.mesh.points.size(); ++v) {
      const Point& p = after.mesh.points[v];
      CHECK(values[2 * v] == doctest::Approx(p.x + 2 * p.y));
      CHECK(values[2 * v + 1] == doctest::Approx(3 - p.x));
    }
  }
}

TEST_CASE("fields at corners of triangles keep their integrals, and their values in triangles that stay") {
  const Mesh before = large_grid();
  const std::vector<adapt::Field> fields{tilted_at_corners(before, 1), tilted_at_corners(before, 5)};
  for (const double length : {0.5, 3.0}) {
    CAPTURE(length);
    const patch::Remade after = made_anew(before, kMiddle, length, fields);
    std::size_t stayed = 0;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      CHECK(integral(after.mesh, after.fields[k]) == doctest::Approx(integral(before, fields[k])).epsilon(1e-12));
      for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t) {
        if (after.old_triangles[t] < 0) continue;
        const auto old = static_cast<std::size_t>(after.old_triangles[t]);
        for (std::size_t i = 0; i < 3; ++i) CHECK(after.fields[k].values[3 * t + i] == fields[k].values[3 * old + i]);
        ++stayed;
      }
    }
    CHECK(stayed > 200);
  }
}

TEST_CASE("data of triangles that get other numbers go along") {
  // The three upper rows are taken as well. Most of their triangles stay, and the last ones get the numbers of some
  // that are gone.
  const Mesh before = unit_squares(40, 5);
  adapt::Field field{FieldPlace::kTriangles, Transfer::kInterpolate, 1, {}};
  for (std::size_t t = 0; t < before.triangles.size(); ++t) field.values.push_back(static_cast<double>(t));
  const patch::Remade after = made_anew(before, {{0, 0}, {40, 2}}, 3, {field, field, field});
  std::size_t moved = 0;
  for (const adapt::Field& now : after.fields) {
    REQUIRE(now.values.size() == after.mesh.triangles.size());
    for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t) {
      if (after.old_triangles[t] < 0) continue;
      CHECK(now.values[t] == after.old_triangles[t]);
      moved += std::cmp_not_equal(after.old_triangles[t], t) ? 1 : 0;
    }
  }
  CHECK(moved > 0);
}

TEST_CASE("a weir goes along where its points get other numbers, and numbers of a whole mesh are gone") {
  Mesh before = large_grid();
  const auto last = static_cast<std::int32_t>(before.points.size()) - 1;
  before.weirs.push_back({.type = 24, .points = {last - 1, 0}, .across = {last, 1}, .values = {1, 1, 1, 1, 1, 1}});
  before.numbers.resize(before.points.size());
  std::iota(before.numbers.begin(), before.numbers.end(), 100);
  const patch::Remade after = made_anew(before, kMiddle, 3);
  REQUIRE(after.mesh.points.size() < before.points.size());
  const Mesh::Weir& weir = after.mesh.weirs.front();
  const auto at = [&](std::int32_t v) { return after.mesh.points.at(static_cast<std::size_t>(v)); };
  CHECK(at(weir.points[0]) == Point{13, 14});
  CHECK(at(weir.across[0]) == Point{14, 14});
  CHECK(weir.points[1] == 0);
  CHECK(weir.across[1] == 1);
  CHECK(after.mesh.numbers.empty());
}

TEST_CASE("what is reported as gone and as new makes up the difference") {
  const Mesh before = large_grid();
  for (const double length : {0.5, 3.0}) {
    CAPTURE(length);
    const patch::Remade after = made_anew(before, kMiddle, length);
    const patch::Report& report = after.report;
    CHECK(report.inside == 32);
    CHECK(report.gone_points == std::ssize(before.points) - (std::ssize(after.old_points) - report.new_points));
    CHECK(report.gone == std::ssize(before.triangles) - (std::ssize(after.old_triangles) - report.made));
    CHECK(report.new_points == std::ranges::count(after.old_points, -1));
    CHECK(report.made == std::ranges::count(after.old_triangles, -1));
    CHECK(report.gone_points > 0);
  }
}

TEST_CASE("a part is made anew although the outline changes elsewhere, or not at all") {
  const Mesh before = large_grid();
  for (const double corner : {14.0, 13.5}) {
    CAPTURE(corner);
    patch::NewDomain domain{square_domain(14), 1e-12};
    domain.pslg.points[0] = {14 - corner, 14 - corner};
    patch::Order order{.inside = patch::triangles_in(before, Box{{10, 10}, {12, 12}}), .domain = &domain};
    order.lengths.assign(before.points.size(), 0.5);
    const patch::Remade after = patch::remake(before, {}, order);
    CHECK(after.report.inside >= 8);
    for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = after.mesh.triangles[t];
      const auto place = [&](std::int32_t v) { return after.mesh.points[static_cast<std::size_t>(v)]; };
      const Point center = centroid({place(a), place(b), place(c)});
      if (std::abs(center.x - 11) < 1 && std::abs(center.y - 11) < 1) CHECK(area_at(after.mesh, t) < 0.25);
    }
  }
}

TEST_CASE("a length of next to nothing at one point takes few triangles") {
  const Mesh before = unit_squares(9, 9);
  for (const double least : {1e-4, 1e-9, 1e-300}) {
    CAPTURE(least);
    patch::Order order{.inside = std::vector<bool>(before.triangles.size(), true)};
    order.lengths.assign(before.points.size(), 1);
    order.lengths[34] = least;
    const patch::Remade after = patch::remake(before, {}, order);
    CHECK(after.mesh.triangles.size() > 1'000);
    CHECK(after.mesh.triangles.size() < 30'000);
    CHECK(whole_area(after.mesh) == doctest::Approx(81));
  }
}

TEST_CASE("what surely is too much is refused before it is made") {
  const Mesh before = unit_squares(9, 9);
  for (const double most : {0.0, 1e6}) {
    patch::Order order{.inside = std::vector<bool>(before.triangles.size(), true), .options = {.most_triangles = most}};
    order.lengths.assign(before.points.size(), most == 0 ? 1e-9 : 1e-3);
    CHECK_THROWS_WITH_AS(static_cast<void>(patch::remake(before, {}, order)),
                         doctest::Contains(most == 0 ? "which no mesh has" : "allow more triangles"), LimitError);
  }
}

TEST_CASE("what comes to another region does not stay, wherever its triangles are") {
  Mesh before = unit_squares(16, 8);
  for (std::size_t t = 0; t < before.triangles.size(); ++t) before.regions.push_back(t % 32 < 8 ? 1 : 2);
  patch::NewDomain domain{{}, 1e-12};
  domain.pslg.points = {{0, 0}, {4, 0}, {16, 0}, {16, 8}, {4, 8}, {0, 8}};
  domain.pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 5, 1}, {5, 0, 1}, {1, 4, 0}};
  domain.pslg.regions = {{{1, 1}, 3, 0}, {{6, 1}, 2, 0}};
  patch::Order order{.domain = &domain};
  order.lengths.assign(before.points.size(), std::sqrt(2.0));
  const patch::Remade after = patch::remake(before, {}, order);
  std::int64_t stayed = 0;
  for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t)
    if (const std::int32_t old = after.old_triangles[t]; old >= 0) {
      CHECK(after.mesh.regions[t] == before.regions[static_cast<std::size_t>(old)]);
      ++stayed;
    }
  CHECK(stayed > 64);
  CHECK(after.report.made == std::ssize(after.mesh.triangles) - stayed);
}

TEST_CASE("an island beside a mesh begins at the nearest triangle") {
  Mesh mesh = unit_squares(9, 9);
  patch::NewDomain domain{square_domain(9), 1e-12};
  for (const Point& p : {Point{10, 4.2}, Point{11, 4.2}, Point{11, 4.6}, Point{10, 4.6}})
    domain.pslg.points.push_back(p);
  for (std::int32_t i = 0; i < 4; ++i) domain.pslg.segments.push_back({4 + i, 4 + (i + 1) % 4, 1});
  const patch::OutlineChange change = patch::compare_outlines(mesh, domain);
  CHECK(change.match.pieces.size() == 4);
  std::vector<bool> nearest(mesh.triangles.size(), false);
  nearest[2 * (4 * 9 + 8)] = true;  // in the square at (8, 4) the one below the diagonal
  CHECK(change.inside == nearest);
}

TEST_CASE("a side that bends by rounding at each point, and by more in all, stays as it is") {
  Mesh before = unit_squares(9, 9);
  for (std::size_t k = 0; k <= 9; ++k)
    before.points[90 + k].y += std::ldexp(static_cast<double>(k * (9 - k)), -48);  // 2 units in the last place each
  std::swap(before.points[92], before.points[96]);  // along the side numbers go up and down
  for (auto& corners : before.triangles)
    for (std::int32_t& v : corners) v = v == 92 ? 96 : v == 96 ? 92 : v;
  const patch::Remade after = patch::remake(before, {}, {.inside = std::vector<bool>(before.triangles.size(), true)});
  for (std::int32_t v = 90; v < 100; ++v) CHECK(std::ranges::count(after.old_points, v) == 1);
  CHECK(whole_area(after.mesh) == doctest::Approx(81));
  const patch::Remade fine = made_anew(before, {{-1, -1}, {10, 10}}, 0.7);
  CHECK(fine.mesh.triangles.size() > before.triangles.size());
  CHECK(whole_area(fine.mesh) == doctest::Approx(81));
}

TEST_CASE("what is made anew in subdomains beside parts that stay has subdomains of its own") {
  Mesh mesh = large_grid();
  const auto points = static_cast<std::int32_t>(mesh.points.size());
  const std::size_t triangles = mesh.triangles.size();
  for (const Point& p : unit_squares(3, 3).points) mesh.points.push_back({p.x + 20, p.y});
  for (const auto& [a, b, c] : unit_squares(3, 3).triangles)
    mesh.triangles.push_back({a + points, b + points, c + points});
  for (const bool has_some : {false, true}) {
    if (has_some) mesh.subdomains.assign(mesh.triangles.size(), 4);
    patch::Order order{.inside = std::vector<bool>(mesh.triangles.size(), false)};
    std::fill_n(order.inside.begin(), triangles, true);
    order.lengths.assign(mesh.points.size(), 0.4);
    order.cut_from = 0;
    const patch::Remade after = patch::remake(mesh, {}, std::move(order));
    REQUIRE(after.mesh.subdomains.size() == after.mesh.triangles.size());
    const std::int32_t other = has_some ? 4 : 0;
    std::int32_t most = 0;
    for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t) {
      CHECK((after.mesh.subdomains[t] == other) == (after.old_triangles[t] >= 0));
      most = std::max(most, after.mesh.subdomains[t]);
    }
    CHECK(most > other + 10);
  }
}

TEST_CASE("more triangles than are allowed in a part are one clear error") {
  Mesh mesh = large_grid();
  patch::Order order{.inside = patch::triangles_in(mesh, kMiddle), .options = {.most_triangles = 500}};
  order.lengths.assign(mesh.points.size(), 0.1);
  CHECK_THROWS_WITH_AS(
      (void)patch::remake(std::move(mesh), {}, std::move(order)),
      "lengths ask for more than 500 triangles in what is made anew; ask for longer ones, or allow more triangles",
      LimitError);
}

TEST_CASE("a mesh that is all made anew as one has no subdomains, and its boundary is listed") {
  Mesh mesh = large_grid();
  REQUIRE(mesh.edges.empty());
  CHECK(made_anew(mesh, kMiddle, 0.5).mesh.edges.size() == 4 * 14);
  mesh.subdomains.assign(mesh.triangles.size(), 4);
  const patch::Remade after = made_anew(mesh, {{-1, -1}, {15, 15}}, 0.7);
  CHECK(after.mesh.triangles.size() > mesh.triangles.size());
  CHECK(after.mesh.subdomains.empty());
}
