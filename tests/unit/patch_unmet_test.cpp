#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/bound_forecast.hpp"
#include "mesh/bounds.hpp"
#include "patch/part.hpp"
#include "patch/unmet.hpp"
#include "unit_squares.hpp"

// Which triangles of a finished mesh are not as lengths and an angle bound want them, where that can be told by hand.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

constexpr double kNothingIsDense = 1e3;
constexpr AdaptiveOptions kAsAsked{.gradation = 0};

Mesh small_mesh(std::vector<Point> points, std::vector<std::array<std::int32_t, 3>> triangles) {
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.triangles = std::move(triangles);
  return mesh;
}

patch::Unmet find_unmet(const Mesh& mesh, const std::vector<double>& lengths, const AdaptiveOptions& options,
                        double min_angle, double threshold) {
  return patch::find_unmet(mesh, patch::link(mesh).triangulation, lengths, options, min_angle, threshold);
}

/// The half of a square of side 2 below its diagonal.
Mesh half_square() {
  return small_mesh({{0, 0}, {2, 0}, {2, 2}}, {{0, 1, 2}});
}

Mesh whole_square() {
  return small_mesh({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}});
}

/// The edge of an equilateral triangle with the area of half a square of side 2.
const double kSuitable = std::sqrt(2 * 4 / std::numbers::sqrt3);

/// Angles of 18 degrees between sides and the diagonal.
Mesh narrow_rectangle() {
  return small_mesh({{0, 0}, {1, 0}, {1, 3}, {0, 3}}, {{0, 1, 2}, {0, 2, 3}});
}

/// A rhombus that is cut along its longer diagonal.
Mesh wrong_diagonal() {
  return small_mesh({{0, 0}, {4, 0}, {2, -1}, {2, 1}}, {{0, 2, 1}, {0, 1, 3}});
}

std::int64_t count_not_delaunay(const Mesh& mesh) {
  const patch::Unmet unmet = find_unmet(mesh, {}, kAsAsked, 0, kNothingIsDense);
  CHECK(std::ranges::count(unmet.triangles, true) == unmet.not_delaunay);
  return unmet.not_delaunay;
}

}  // namespace

TEST_CASE("a triangle is too large for the least length at its corners") {
  const auto too_large = [](const std::vector<double>& lengths, const AdaptiveOptions& options) {
    return find_unmet(half_square(), lengths, options, 0, kNothingIsDense).too_large;
  };
  const double less = 0.99 * kSuitable, more = 1.01 * kSuitable;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    std::vector<double> lengths(3, 2 * more);
    lengths[corner] = more;
    CHECK(too_large(lengths, kAsAsked) == 0);
    lengths[corner] = less;
    CHECK(too_large(lengths, kAsAsked) == 1);
  }
  CHECK(too_large({less, less, less}, {.shortest = more, .gradation = 0}) == 0);
  CHECK(too_large({9, 9, 9}, {.longest = less, .gradation = 0}) == 1);
  CHECK(too_large({}, {.longest = less}) == 1);
  CHECK(too_large({}, {.longest = more}) == 0);
}

TEST_CASE("lengths that are asked for grow slowly") {
  const std::vector<double> lengths{9, 0.7 * kSuitable, 9, 9};  // the second point is a corner of one triangle alone
  const auto too_large = [&](double gradation) {
    return find_unmet(whole_square(), lengths, {.gradation = gradation}, 0, kNothingIsDense).too_large;
  };
  CHECK(too_large(0) == 1);
  CHECK(too_large(0.1 * kSuitable) == 2);  // 2 on
  CHECK(too_large(0.2 * kSuitable) == 1);
}

TEST_CASE("a triangle counts for the first reason that it has") {
  const patch::Unmet both = find_unmet(narrow_rectangle(), {}, {.longest = 1}, 20, kNothingIsDense);
  CHECK(both.too_large == 2);
  CHECK(both.skinny == 0);
  const patch::Unmet one = find_unmet(narrow_rectangle(), {}, {}, 20, kNothingIsDense);
  CHECK(one.too_large == 0);
  CHECK(one.skinny == 2);
  CHECK(one.triangles == std::vector{true, true});
}

TEST_CASE("an angle of the outline is met") {
  const Mesh wedge = small_mesh({{0, 0}, {4, 0}, {4, 1}}, {{0, 1, 2}});  // 14 degrees
  CHECK(find_unmet(wedge, {}, kAsAsked, 20, kNothingIsDense).skinny == 0);
}

TEST_CASE("the threshold is one of lengths") {
  const Mesh mesh = unit_squares(9, 9);
  const double met = std::sqrt(kTrianglesPerBound / twice_area_of_edge(1));  // twice the area of each is 1
  const auto too_dense = [&](double length, double threshold) {
    const std::vector<double> lengths(mesh.points.size(), length);
    return find_unmet(mesh, lengths, kAsAsked, 0, threshold).too_dense;
  };
  CHECK(too_dense(1.99 * met, 2) == 0);
  CHECK(too_dense(2.01 * met, 2) == 162);
}

TEST_CASE("a triangle far too large does not make up for many that are too dense") {
  const Mesh mesh = unit_squares(9, 9);
  std::vector<double> lengths(mesh.points.size(), 8.0);
  lengths[44] = 0.05;  // a corner of six triangles
  const patch::Unmet unmet = find_unmet(mesh, lengths, kAsAsked, 0, 1.3);
  CHECK(unmet.too_large == 6);
  // These count as four triangles each, and means keep sums. So they can lift no more than 42 above 1 / 1.3 squared.
  CHECK(unmet.too_dense > 162 - 42);
  CHECK(find_unmet(mesh, std::vector<double>(mesh.points.size(), 8.0), kAsAsked, 0, 1.3).too_dense == 162);
}

TEST_CASE("an edge is to be Delaunay unless something passes along it") {
  Mesh mesh = wrong_diagonal();
  CHECK(count_not_delaunay(mesh) == 2);
  mesh.subdomains = {3, 3};
  mesh.regions = {5, 5};
  mesh.edges = {{0, 2, 1}};
  CHECK(count_not_delaunay(mesh) == 2);
  mesh.edges.push_back({1, 0, 0});
  CHECK(count_not_delaunay(mesh) == 0);
  mesh.edges.pop_back();
  mesh.subdomains[1] = 4;
  CHECK(count_not_delaunay(mesh) == 0);
  mesh.subdomains.clear();
  CHECK(count_not_delaunay(mesh) == 2);
  mesh.regions[0] = 4;
  CHECK(count_not_delaunay(mesh) == 0);
  mesh.regions.clear();
  CHECK(count_not_delaunay(mesh) == 2);
}
