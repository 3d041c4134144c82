// Nanoseconds a call of the exact predicates, on random input and on input that the filters cannot decide.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kPoints = 4096;  // 64 KiB: the input stays in cache

std::vector<Point> random_points() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point> points(kPoints + 3);
  for (Point& p : points) p = {unit(random), unit(random)};
  return points;
}

/// Points of a small integer grid: many collinear triples and cocircular quadruples.
std::vector<Point> degenerate_points() {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> cell(0, 3);
  std::vector<Point> points(kPoints + 3);
  for (Point& p : points) p = {cell(random) / 10.0, cell(random) / 10.0};
  return points;
}

void count_calls(benchmark::State& state) {
  const auto calls = static_cast<double>(kPoints);
  state.counters["call"] =
      benchmark::Counter(calls, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void orient2d_on(benchmark::State& state, const std::vector<Point>& points) {
  for (auto _ : state) {
    int left = 0;
    for (std::size_t i = 0; i < kPoints; ++i) left += orient2d(points[i], points[i + 1], points[i + 2]) > 0;
    benchmark::DoNotOptimize(left);
  }
  count_calls(state);
}

void incircle_on(benchmark::State& state, const std::vector<Point>& points) {
  for (auto _ : state) {
    int inside = 0;
    for (std::size_t i = 0; i < kPoints; ++i)
      inside += incircle(points[i], points[i + 1], points[i + 2], points[i + 3]) > 0;
    benchmark::DoNotOptimize(inside);
  }
  count_calls(state);
}

BENCHMARK_CAPTURE(orient2d_on, random, random_points());
BENCHMARK_CAPTURE(incircle_on, random, random_points());
BENCHMARK_CAPTURE(orient2d_on, degenerate, degenerate_points());
BENCHMARK_CAPTURE(incircle_on, degenerate, degenerate_points());

}  // namespace
}  // namespace driftmesh

BENCHMARK_MAIN();
