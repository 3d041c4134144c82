// What memory costs the refiner: the same square refined to meshes that fit in a cache and to meshes that do not.
//
//   driftmesh_bench_kernel [Google Benchmark's options]

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cstdint>

#include "driftmesh/pslg.hpp"
#include "support/made_mesh.hpp"

namespace driftmesh {
namespace {

Pslg square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  return pslg;
}

/// The argument is about the number of triangles.
void refine(benchmark::State& state) {
  const Pslg pslg = square();
  const job::Request request = testing::bounded(20, 1.55 / static_cast<double>(state.range(0)));
  std::int64_t triangles = 0;
  for ([[maybe_unused]] auto _ : state) {
    const job::RunRecord record = testing::made(pslg, request).record;
    state.SetIterationTime(record.seconds_refine);
    triangles += record.triangles;
  }
  state.SetItemsProcessed(triangles);
}
BENCHMARK(refine)
    ->UseManualTime()
    ->Arg(10'000)
    ->Arg(20'000)
    ->Arg(40'000)
    ->Arg(100'000)
    ->Arg(400'000)
    ->Arg(1'000'000)
    ->Arg(4'000'000);

/// Memory that was freed is used again: fresh pages are a matter of the system.
[[maybe_unused]] const int kept = mallopt(M_MMAP_THRESHOLD, 1 << 30) + mallopt(M_TRIM_THRESHOLD, INT32_MAX);

}  // namespace
}  // namespace driftmesh

BENCHMARK_MAIN();
