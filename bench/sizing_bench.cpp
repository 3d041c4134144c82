// Nanoseconds per query of what size fields are compiled from. A refiner makes about one for each point that it
// inserts.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "sizing/background_function.hpp"
#include "sizing/expression_field.hpp"

namespace {

using namespace driftmesh;

/// The unit square as n x n cells of two triangles; grid lines are concentrated near the origin by `power`.
std::shared_ptr<const BackgroundMesh> square(int n, double power) {
  std::vector<Point> points;
  std::vector<BackgroundMesh::Triangle> triangles;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) points.push_back({std::pow(double(i) / n, power), std::pow(double(j) / n, power)});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  return std::make_shared<const BackgroundMesh>(std::move(points), std::move(triangles));
}

std::vector<Point> random_points(double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<Point> points(4096);
  for (Point& p : points) p = {uniform(random), uniform(random)};
  return points;
}

void ask(benchmark::State& state, const PlaneFunction& function, const std::vector<Point>& points) {
  for (auto _ : state)
    for (const Point& p : points) benchmark::DoNotOptimize(function.at(p));
  state.counters["call"] = benchmark::Counter(
      static_cast<double>(points.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void vertex_field(benchmark::State& state, double power, double low, double high) {
  const auto mesh = square(static_cast<int>(state.range(0)), power);
  ask(state, *BackgroundFunction::of_points(mesh, std::vector<double>(mesh->points().size(), 1)),
      random_points(low, high));
}

void area_field(benchmark::State& state) {
  const auto mesh = square(static_cast<int>(state.range(0)), 1);
  ask(state, *BackgroundFunction::of_areas(mesh, std::vector<double>(mesh->triangles().size(), 1)),
      random_points(0, 1));
}

void expression(benchmark::State& state) {
  ask(state, *ExpressionField("0.01 + 0.1*hypot(x, y)").function(), random_points(0, 1));
}

/// A coast around the middle of the unit square, with bays within bays, as one closed line of so many segments.
Pslg coast(int count) {
  Pslg pslg;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    double radius = 0.3;
    for (int k = 1; k <= 13; ++k) radius += 0.12 * std::pow(0.6, k) * std::sin((1 << k) * angle + k * k);
    pslg.points.push_back({0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle)});
    pslg.segments.push_back({i, (i + 1) % count, 1});
  }
  return pslg;
}

/// In the order of a mesh, from square to square, so that caches help as they do there.
std::vector<Point> points_in_rows() {
  std::vector<Point> points;
  for (int j = 0; j < 512; ++j)
    for (int i = 0; i < 512; ++i) points.push_back({(i + 0.3) / 512, (j + 0.7) / 512});
  return points;
}

/// The first questions make the squares that answer the others.
void distance(benchmark::State& state) {
  const Pslg pslg = coast(static_cast<int>(state.range(0)));
  ask(state, *ExpressionField("distance() + 1", 0, std::numeric_limits<double>::infinity(), &pslg).function(),
      points_in_rows());
}

BENCHMARK_CAPTURE(vertex_field, inside, 1, 0, 1)->Arg(10)->Arg(100)->Arg(500);
BENCHMARK_CAPTURE(vertex_field, inside_graded, 5, 0, 1)->Arg(500);
BENCHMARK_CAPTURE(vertex_field, outside, 1, 1.1, 2)->Arg(500);
BENCHMARK(area_field)->Arg(500);
BENCHMARK(expression);
BENCHMARK(distance)->Arg(1)->Arg(1000)->Arg(14'000)->Arg(200'000);

}  // namespace

BENCHMARK_MAIN();
