// Triangles written, read and drawn per second. Files go to the folder TMPDIR and stay in the page cache.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>

#include "io/mesh_file.hpp"
#include "picture/plot.hpp"

namespace {

using namespace driftmesh;

/// The unit square as n x n jittered cells of two triangles: two regions, four boundary markers.
Mesh square(std::int32_t n) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  const auto place = [&](std::int32_t i) { return i % n == 0 ? i / double(n) : (i + jitter(random)) / n; };
  Mesh mesh;
  for (std::int32_t j = 0; j <= n; ++j)
    for (std::int32_t i = 0; i <= n; ++i) {
      const double x = place(i);
      mesh.points.push_back({x, place(j)});
      mesh.point_markers.push_back(i % n == 0 || j % n == 0 ? 1 : 0);
    }
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
      mesh.regions.insert(mesh.regions.end(), 2, 2 * i < n ? 1 : 2);
    }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t top = n * (n + 1);
    mesh.edges.push_back({i, i + 1, 1});
    mesh.edges.push_back({top + i, top + i + 1, 2});
    mesh.edges.push_back({i * (n + 1), (i + 1) * (n + 1), 3});
    mesh.edges.push_back({i * (n + 1) + n, (i + 1) * (n + 1) + n, 4});
  }
  return mesh;
}

const Mesh& mesh_of(std::int64_t triangles) {
  static Mesh mesh;
  if (static_cast<std::int64_t>(mesh.triangles.size()) < triangles)
    mesh = square(static_cast<std::int32_t>(std::sqrt(static_cast<double>(triangles) / 2)));
  return mesh;
}

std::string file_name(const char* extension) {
  return std::filesystem::temp_directory_path() / (std::string("driftmesh-bench").append(extension));
}

void remove_files(const std::string& path) {
  for (const std::string& file : mesh_files(path)) std::filesystem::remove(file);
}

void report(benchmark::State& state, const Mesh& mesh, const std::string& path) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
  std::int64_t bytes = 0;
  for (const std::string& file : mesh_files(path)) bytes += static_cast<std::int64_t>(std::filesystem::file_size(file));
  state.SetBytesProcessed(state.iterations() * bytes);
}

void write(benchmark::State& state, const char* extension) {
  const Mesh& mesh = mesh_of(state.range(0));
  const std::string path = file_name(extension);
  for (auto _ : state) write_mesh(mesh, path);
  report(state, mesh, path);
  remove_files(path);
}

void read(benchmark::State& state, const char* extension) {
  const Mesh& mesh = mesh_of(state.range(0));
  const std::string path = file_name(extension);
  write_mesh(mesh, path);
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(path).points.size());
  report(state, mesh, path);
  remove_files(path);
}

void plot(benchmark::State& state, PlotColor color) {
  const Mesh& mesh = mesh_of(state.range(0));
  const std::string path = file_name(".png");
  for (auto _ : state) plot_mesh(mesh, path, {.color = color});
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
  std::filesystem::remove(path);
}

void settings(benchmark::internal::Benchmark* bench) {
  bench->Arg(10'000'000)->Iterations(3)->Unit(benchmark::kSecond)->UseRealTime();
}

BENCHMARK_CAPTURE(write, vtu, ".vtu")->Apply(settings);
BENCHMARK_CAPTURE(write, msh, ".msh")->Apply(settings);
BENCHMARK_CAPTURE(write, triangle, ".ele")->Apply(settings);
BENCHMARK_CAPTURE(read, vtu, ".vtu")->Apply(settings);
BENCHMARK_CAPTURE(read, msh, ".msh")->Apply(settings);
BENCHMARK_CAPTURE(read, triangle, ".ele")->Apply(settings);
BENCHMARK_CAPTURE(plot, angle, PlotColor::kAngle)->Apply(settings);
BENCHMARK_CAPTURE(plot, area, PlotColor::kArea)->Apply(settings);

}  // namespace

BENCHMARK_MAIN();
