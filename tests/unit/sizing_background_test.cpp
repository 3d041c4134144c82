#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "sizing/background_field.hpp"
#include "sizing/gradation.hpp"
#include "sizing_mesh_fixture.hpp"
#include "support/infinity.hpp"

using namespace driftmesh;
using driftmesh::testing::FlatMesh;
using driftmesh::testing::kInfinity;
using driftmesh::testing::square_mesh;

namespace {

double linear(const Point& p) {
  return 10 + 0.75 * p.x - 0.3 * p.y;
}

VertexSizeField linear_field(const FlatMesh& mesh) {
  std::vector<double> lengths;
  for (const Point& p : mesh.points) lengths.push_back(linear(p));
  return {{mesh.points, mesh.triangles}, lengths};
}

std::vector<Point> random_points(double low, double high, int count) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<Point> points(count);
  for (Point& p : points) p = {uniform(random), uniform(random)};
  return points;
}

/// Points inside and outside a mesh of side n, at its corners and at the midpoints of its edges.
std::vector<Point> telling_points(const FlatMesh& mesh, double n) {
  std::vector<Point> points = random_points(-0.3 * n, 1.3 * n, 2000);
  points.insert(points.end(), mesh.points.begin(), mesh.points.end());
  for (const auto& [a, b, c] : mesh.triangles) points.push_back(midpoint(mesh.points[a], mesh.points[b]));
  return points;
}

}  // namespace

TEST_CASE("linear functions are interpolated exactly") {
  const FlatMesh mesh = square_mesh(12);
  const VertexSizeField field = linear_field(mesh);
  for (const Point& p : random_points(0, 12, 3000))
    CHECK(field.edge_length(p) == doctest::Approx(linear(p)).epsilon(1e-13));
  for (const Point& p : mesh.points) CHECK(field.edge_length(p) == linear(p));
}

TEST_CASE("outside the mesh, the value at the nearest point of its boundary applies") {
  const FlatMesh mesh = square_mesh(12);
  const VertexSizeField field = linear_field(mesh);
  int outside = 0;
  for (const Point& p : random_points(-20, 30, 2000)) {
    const Point nearest{std::clamp(p.x, 0.0, 12.0), std::clamp(p.y, 0.0, 12.0)};
    outside += nearest != p;
    CHECK(field.edge_length(p) == doctest::Approx(linear(nearest)).epsilon(1e-13));
  }
  CHECK(outside > 1000);
}

TEST_CASE("a hole of the mesh is outside") {
  const FlatMesh mesh = square_mesh(12, 4);  // the hole is the square from 4 to 8
  const VertexSizeField field = linear_field(mesh);
  for (const Point& p : random_points(4, 8, 500)) {
    const double gap[] = {p.x - 4, 8 - p.x, p.y - 4, 8 - p.y};
    const Point nearest[] = {{4, p.y}, {8, p.y}, {p.x, 4}, {p.x, 8}};
    const auto side = std::min_element(gap, gap + 4) - gap;
    CHECK(field.edge_length(p) == doctest::Approx(linear(nearest[side])).epsilon(1e-13));
  }
}

TEST_CASE("the answer depends on the point alone, not on earlier queries") {
  const FlatMesh mesh = square_mesh(10, 2, false);  // exact degeneracies: queries on edges and corners
  std::vector<double> lengths;
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    lengths.push_back(std::uniform_real_distribution(1.0, 9.0)(random));
  std::vector<Point> points = telling_points(mesh, 10);
  const VertexSizeField field({mesh.points, mesh.triangles}, lengths);
  std::vector<double> first;
  for (const Point& p : points) first.push_back(field.edge_length(p));
  for (int round = 0; round < 3; ++round) {
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    const VertexSizeField fresh({mesh.points, mesh.triangles}, lengths);
    for (const std::size_t i : order) CHECK(fresh.edge_length(points[i]) == first[i]);
  }
}

TEST_CASE("the triangles at a point are those that an exhaustive search finds") {
  const FlatMesh flat = square_mesh(8, 2, false);
  const BackgroundMesh mesh(flat.points, flat.triangles);
  for (const Point& p : telling_points(flat, 8)) {
    std::vector<std::int32_t> expected;
    for (std::size_t t = 0; t < flat.triangles.size(); ++t) {
      const auto& [i, j, k] = flat.triangles[t];
      const Point &a = flat.points[i], &b = flat.points[j], &c = flat.points[k];
      const double turn = orient2d(a, b, c);
      if (orient2d(a, b, p) * turn >= 0 && orient2d(b, c, p) * turn >= 0 && orient2d(c, a, p) * turn >= 0)
        expected.push_back(static_cast<std::int32_t>(t));
    }
    if (expected.empty())
      CHECK(mesh.triangles_at(p).size() == 1);
    else
      CHECK(mesh.triangles_at(p) == expected);
  }
}

TEST_CASE("triangles without area are ignored") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {2, 0}, {0, 2}};
  const VertexSizeField field({points, {{0, 1, 2}, {0, 2, 3}}}, {1, 100, 3, 5});
  CHECK(field.edge_length({1, 0}) == 2);
  CHECK(field.edge_length({1, -7}) == 2);
}

TEST_CASE("an unbounded corner makes the triangles around it unbounded") {
  const VertexSizeField field({{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}}, {1, 3, kInfinity});
  CHECK(field.edge_length({0.5, 0}) == 2);
  CHECK(field.edge_length({0.25, 0.25}) == kInfinity);
}

TEST_CASE("gradation: no edge exceeds the limit, and no larger function respects it") {
  const FlatMesh mesh = square_mesh(7, 1);
  const std::size_t n = mesh.points.size();
  std::mt19937_64 random(9);
  std::vector<double> lengths(n);
  for (double& length : lengths) length = std::exp(std::uniform_real_distribution(-4.0, 3.0)(random));
  lengths[3] = kInfinity;
  for (const double gradation : {0.05, 0.25, 1.0}) {
    // The oracle: shortest paths between all pairs of points.
    std::vector<double> way(n * n, kInfinity);
    for (std::size_t i = 0; i < n; ++i) way[i * n + i] = 0;
    for (const auto& t : mesh.triangles)
      for (const auto i : t)
        for (const auto j : t) {
          const Point &p = mesh.points[i], &q = mesh.points[j];
          way[i * n + j] = std::hypot(p.x - q.x, p.y - q.y);
        }
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) way[i * n + j] = std::min(way[i * n + j], way[i * n + k] + way[k * n + j]);

    std::vector<double> limited = lengths;
    limit_gradation(mesh.points, mesh.triangles, gradation, limited);
    int lowered = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double largest = kInfinity;
      for (std::size_t j = 0; j < n; ++j) largest = std::min(largest, lengths[j] + gradation * way[j * n + i]);
      CHECK(limited[i] == doctest::Approx(largest).epsilon(1e-12));
      lowered += limited[i] < lengths[i];
    }
    CHECK(lowered > 10);
    std::vector<double> again = limited;
    limit_gradation(mesh.points, mesh.triangles, gradation, again);
    CHECK(again == limited);
  }
}

TEST_CASE("gradation spreads only along edges") {
  std::vector<double> lengths{1, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity};
  limit_gradation({{0, 0}, {1, 0}, {0, 1}, {5, 5}, {6, 5}, {5, 6}}, {{0, 1, 2}, {3, 4, 5}}, 0.5, lengths);
  CHECK(lengths == std::vector<double>{1, 1.5, 1.5, kInfinity, kInfinity, kInfinity});
}

TEST_CASE("area bounds apply triangle by triangle, the largest one where triangles meet") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const TriangleAreaField field({points, {{0, 1, 2}, {0, 2, 3}}}, {0.01, 0.04});
  const auto area = [&](const Point& p) { return std::sqrt(3.0) / 4 * field.edge_length(p) * field.edge_length(p); };
  CHECK(area({0.7, 0.2}) == doctest::Approx(0.01));
  CHECK(area({0.2, 0.7}) == doctest::Approx(0.04));
  CHECK(area({0.5, 0.5}) == doctest::Approx(0.04));
  CHECK(area({1, 1}) == doctest::Approx(0.04));
  CHECK(area({3, 0.5}) == doctest::Approx(0.01));
  const TriangleAreaField half_bounded({points, {{0, 1, 2}, {0, 2, 3}}}, {0.01, -1});
  CHECK(half_bounded.edge_length({0.2, 0.7}) == kInfinity);
  CHECK(half_bounded.edge_length({0.7, 0.2}) == doctest::Approx(std::sqrt(0.04 / std::sqrt(3.0))));
}

TEST_CASE("unusable background meshes are rejected") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {2, 0}, {0, 1}};
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, 4}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, -1}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, 2}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {}), Error);
  const BackgroundMesh mesh(points, {{0, 1, 3}});
  CHECK_THROWS_AS(VertexSizeField(mesh, {1, 2, 3}), Error);
  CHECK_THROWS_AS(VertexSizeField(mesh, {1, 2, 3, 0}), Error);
  CHECK_THROWS_AS(VertexSizeField(mesh, {1, 2, 3, std::nan("")}), Error);
  CHECK_THROWS_AS(TriangleAreaField(mesh, {1, 2}), Error);
  CHECK_THROWS_AS(TriangleAreaField(mesh, {std::nan("")}), Error);
}
