// Nanoseconds per call of the exact predicates, on random input and where the filter cannot decide.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/hilbert.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace {

using namespace driftmesh;

constexpr std::size_t kCases = 4096;  // 256 KiB: arithmetic is measured, not memory
using Quads = std::vector<std::array<Point, 4>>;

std::mt19937_64 generator(1);
double uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

template <class Make>
Quads quads(Make make) {
  Quads result(kCases);
  for (auto& quad : result) quad = make();
  return result;
}

Quads random_quads() {
  return quads([] {
    std::array<Point, 4> q;
    for (Point& p : q) p = {uniform(0, 1), uniform(0, 1)};
    return q;
  });
}

/// Points on a line through the unit square, rounded.
Quads nearly_collinear_quads() {
  return quads([] {
    const Point a{uniform(0, 1), uniform(0, 1)}, b{uniform(0, 1), uniform(0, 1)};
    std::array<Point, 4> q;
    for (Point& p : q) {
      const double t = uniform(0, 1);
      p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    }
    return q;
  });
}

/// Points on a circle of the given radius around a center in the unit square, rounded. Differences of the coordinates
/// are exact when the circle is small.
Quads nearly_cocircular_quads(double radius) {
  return quads([radius] {
    const Point center{uniform(0, 1), uniform(0, 1)};
    std::array<Point, 4> q;
    for (Point& p : q) {
      const double angle = uniform(0, 2 * M_PI);
      p = {center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)};
    }
    return q;
  });
}

/// Corners of squares of a uniform grid: cocircular.
Quads square_quads() {
  return quads([] {
    const double x = std::floor(uniform(0, 1000)), y = std::floor(uniform(0, 1000));
    return std::array<Point, 4>{Point{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
  });
}

template <class Body>
void for_each_quad(benchmark::State& state, const Quads& input, Body body) {
  for (auto _ : state)
    for (const auto& [a, b, c, d] : input) benchmark::DoNotOptimize(body(a, b, c, d));
  state.counters["call"] =
      benchmark::Counter(kCases, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void bench_orient2d(benchmark::State& state, const Quads& input) {
  for_each_quad(state, input, [](auto& a, auto& b, auto& c, auto&) { return orient2d(a, b, c); });
}
void bench_incircle(benchmark::State& state, const Quads& input) {
  for_each_quad(state, input, [](auto& a, auto& b, auto& c, auto& d) { return incircle(a, b, c, d); });
}
void bench_circumcenter(benchmark::State& state) {
  for_each_quad(state, random_quads(), [](auto& a, auto& b, auto& c, auto&) { return circumcenter(a, b, c); });
}
void bench_off_center(benchmark::State& state) {
  const double factor = off_center_factor(20);
  for_each_quad(state, random_quads(),
                [factor](auto& a, auto& b, auto& c, auto&) { return off_center_of_triangle(a, b, c, factor); });
}
void bench_hilbert(benchmark::State& state) {
  const HilbertOrder order({0, 0}, {1, 1});
  for_each_quad(state, random_quads(), [&order](auto& a, auto&, auto&, auto&) { return order.index(a); });
}

BENCHMARK_CAPTURE(bench_orient2d, random, random_quads());
BENCHMARK_CAPTURE(bench_orient2d, nearly_collinear, nearly_collinear_quads());
BENCHMARK_CAPTURE(bench_incircle, random, random_quads());
BENCHMARK_CAPTURE(bench_incircle, squares, square_quads());
BENCHMARK_CAPTURE(bench_incircle, nearly_cocircular_small, nearly_cocircular_quads(1e-3));
BENCHMARK_CAPTURE(bench_incircle, nearly_cocircular_large, nearly_cocircular_quads(1));
BENCHMARK(bench_circumcenter);
BENCHMARK(bench_off_center);
BENCHMARK(bench_hilbert);

}  // namespace

BENCHMARK_MAIN();
