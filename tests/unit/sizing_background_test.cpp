#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "sizing/background_function.hpp"
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

using Function = std::shared_ptr<const BackgroundFunction>;

Function of_points(const std::vector<Point>& points, const std::vector<BackgroundMesh::Triangle>& triangles,
                   const std::vector<double>& lengths) {
  return BackgroundFunction::of_points(std::make_shared<const BackgroundMesh>(points, triangles), lengths);
}

Function of_areas(const std::vector<Point>& points, const std::vector<BackgroundMesh::Triangle>& triangles,
                  const std::vector<double>& areas) {
  return BackgroundFunction::of_areas(std::make_shared<const BackgroundMesh>(points, triangles), areas);
}

Function linear_field(const FlatMesh& mesh) {
  std::vector<double> lengths;
  for (const Point& p : mesh.points) lengths.push_back(linear(p));
  return of_points(mesh.points, mesh.triangles, lengths);
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
  const Function field = linear_field(mesh);
  for (const Point& p : random_points(0, 12, 3000)) CHECK(field->at(p) == doctest::Approx(linear(p)).epsilon(1e-13));
  for (const Point& p : mesh.points) CHECK(field->at(p) == linear(p));
}

TEST_CASE("outside the mesh, the value at the nearest point of its boundary applies") {
  const FlatMesh mesh = square_mesh(12);
  const Function field = linear_field(mesh);
  int outside = 0;
  for (const Point& p : random_points(-20, 30, 2000)) {
    const Point nearest{std::clamp(p.x, 0.0, 12.0), std::clamp(p.y, 0.0, 12.0)};
    outside += nearest != p;
    CHECK(field->at(p) == doctest::Approx(linear(nearest)).epsilon(1e-13));
  }
  CHECK(outside > 1000);
}

TEST_CASE("a hole of the mesh is outside") {
  const FlatMesh mesh = square_mesh(12, 4);  // the hole is the square from 4 to 8
  const Function field = linear_field(mesh);
  for (const Point& p : random_points(4, 8, 500)) {
    const double gap[] = {p.x - 4, 8 - p.x, p.y - 4, 8 - p.y};
    const Point nearest[] = {{4, p.y}, {8, p.y}, {p.x, 4}, {p.x, 8}};
    const auto side = std::min_element(gap, gap + 4) - gap;
    CHECK(field->at(p) == doctest::Approx(linear(nearest[side])).epsilon(1e-13));
  }
}

TEST_CASE("the answer depends on the point alone, not on earlier queries") {
  const FlatMesh mesh = square_mesh(10, 2, false);  // exact degeneracies: queries on edges and corners
  std::vector<double> lengths;
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    lengths.push_back(std::uniform_real_distribution(1.0, 9.0)(random));
  std::vector<Point> points = telling_points(mesh, 10);
  const Function field = of_points(mesh.points, mesh.triangles, lengths);
  std::vector<double> first;
  for (const Point& p : points) first.push_back(field->at(p));
  for (int round = 0; round < 3; ++round) {
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    const Function fresh = of_points(mesh.points, mesh.triangles, lengths);
    for (const std::size_t i : order) CHECK(fresh->at(points[i]) == first[i]);
  }
}

TEST_CASE("what is known of a box holds at its points, which have the same lengths within it") {
  std::mt19937_64 random(29);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int narrowed = 0, sloped = 0;
  for (int round = 0; round < 60; ++round) {
    const FlatMesh mesh = square_mesh(12, round % 3 == 0 ? 4 : 0, round % 2 == 0, random());
    const bool of_triangles = round % 4 == 3;
    std::vector<double> values(of_triangles ? mesh.triangles.size() : mesh.points.size());
    for (double& value : values) value = random() % 40 == 0 ? (of_triangles ? -1 : kInfinity) : between(0.5, 2);
    const Function all =
        of_triangles ? of_areas(mesh.points, mesh.triangles, values) : of_points(mesh.points, mesh.triangles, values);
    CAPTURE(round);
    std::shared_ptr<const PlaneFunction> function = all;
    Box box{{between(-3, 10), between(-3, 10)}, {}};
    box.high = {box.low.x + between(1, 5), box.low.y + between(1, 5)};
    for (int depth = 0; depth < 5; ++depth) {
      const Variation known = function->over(box);
      sloped += std::isfinite(known.steepest());
      for (int k = 0; k < 40; ++k) {
        const Point p{between(box.low.x, box.high.x), between(box.low.y, box.high.y)};
        const Point q{between(box.low.x, box.high.x), between(box.low.y, box.high.y)};
        const double at_p = function->at(p), at_q = function->at(q);
        CHECK(at_p == all->at(p));
        CHECK(known.value.holds(at_p));
        if (!std::isfinite(known.steepest()) || std::isinf(known.value.low)) continue;
        CHECK(std::fabs(at_p - at_q) <= known.steepest() * std::hypot(p.x - q.x, p.y - q.y) + 1e-12);
        const double along_x = function->at({q.x, p.y}) - at_p, along_y = function->at({p.x, q.y}) - at_p;
        const Interval in_x = intervals::multiply(known.in_x, {q.x - p.x, q.x - p.x});
        const Interval in_y = intervals::multiply(known.in_y, {q.y - p.y, q.y - p.y});
        CHECK((in_x.low - 1e-12 <= along_x && along_x <= in_x.high + 1e-12));
        CHECK((in_y.low - 1e-12 <= along_y && along_y <= in_y.high + 1e-12));
      }
      if (const auto within = function->within(box)) {
        function = within;
        ++narrowed;
      }
      const Point m = box.center();
      box = random() % 2 == 0 ? Box{box.low, m} : Box{m, box.high};
    }
  }
  CHECK(narrowed > 60);
  CHECK(sloped > 30);
}

TEST_CASE("triangles without area are ignored") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {2, 0}, {0, 2}};
  const Function field = of_points(points, {{0, 1, 2}, {0, 2, 3}}, {1, 100, 3, 5});
  CHECK(field->at({1, 0}) == 2);
  CHECK(field->at({1, -7}) == 2);
}

TEST_CASE("an unbounded corner makes the triangles around it unbounded, but not their other edges") {
  const Function field = of_points({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}, {1, 3, kInfinity});
  CHECK(field->at({0.5, 0}) == 2);
  CHECK(field->at({0.25, 0.25}) == kInfinity);
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
  const Function field = of_areas(points, {{0, 1, 2}, {0, 2, 3}}, {0.01, 0.04});
  const auto area = [&](const Point& p) { return std::sqrt(3.0) / 4 * field->at(p) * field->at(p); };
  CHECK(area({0.7, 0.2}) == doctest::Approx(0.01));
  CHECK(area({0.2, 0.7}) == doctest::Approx(0.04));
  CHECK(area({0.5, 0.5}) == doctest::Approx(0.04));
  CHECK(area({1, 1}) == doctest::Approx(0.04));
  CHECK(area({3, 0.5}) == doctest::Approx(0.01));
  const Function half_bounded = of_areas(points, {{0, 1, 2}, {0, 2, 3}}, {0.01, -1});
  CHECK(half_bounded->at({0.2, 0.7}) == kInfinity);
  CHECK(half_bounded->at({0.7, 0.2}) == doctest::Approx(std::sqrt(0.04 / std::sqrt(3.0))));
}

TEST_CASE("the first of the triangles that meet at a point has it") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& triangles : {std::vector<BackgroundMesh::Triangle>{{0, 1, 2}, {0, 2, 3}}, {{0, 2, 3}, {0, 1, 2}}}) {
    const BackgroundMesh mesh(points, triangles);
    for (const Point& p : {points[0], points[2], Point{0.5, 0.5}}) CHECK(mesh.locate(p).triangle == 0);
  }
}

TEST_CASE("unusable background meshes are rejected") {
  const std::vector<Point> points{{0, 0}, {1, 0}, {2, 0}, {0, 1}};
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, 4}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, -1}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {{0, 1, 2}}), Error);
  CHECK_THROWS_AS(BackgroundMesh(points, {}), Error);
  const std::vector<BackgroundMesh::Triangle> one{{0, 1, 3}};
  for (const std::vector<double>& lengths :
       std::vector<std::vector<double>>{{1, 2, 3}, {1, 2, 3, 0}, {1, 2, 3, std::nan("")}})
    CHECK_THROWS_AS((void)of_points(points, one, lengths), Error);
  CHECK_THROWS_AS((void)of_areas(points, one, {1, 2}), Error);
  CHECK_THROWS_AS((void)of_areas(points, one, {std::nan("")}), Error);
}
