#include "mutants/mesh_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "driftmesh/mesher.hpp"
#include "oracles/grid_mesh.hpp"
#include "oracles/random_pslg.hpp"

namespace driftmesh::mutants {
namespace {

MeshSample meshed(std::string name, Pslg input, const MeshOptions& options) {
  Mesh made = mesh(input, options);
  return {std::move(name), std::move(input), std::move(made)};
}

Pslg ring(const std::vector<Point>& points) {
  Pslg pslg;
  pslg.points = points;
  const auto n = static_cast<std::int32_t>(points.size());
  for (std::int32_t i = 0; i < n; ++i) pslg.segments.push_back({i, (i + 1) % n, i % 3});
  return pslg;
}

/// Two squares with a common corner, and a hole in one of them that touches its side there.
Pslg touching() {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {8, 4}, {8, 8}, {4, 8}, {3, 2}, {2, 3}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 2}, {2, 4, 3}, {4, 5, 3},
                   {5, 6, 3}, {6, 2, 3}, {2, 8, 5}, {8, 7, 5}, {7, 2, 5}};
  pslg.holes = {{3, 3}};
  pslg.regions = {{{1, 1}, 7, 0}, {{7, 7}, -2, 0}};
  return pslg;
}

Pslg random_domain(std::uint64_t seed) {
  oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
  shape.outer_points = 3 + shape.outer_points / 2;
  if (seed % 3 == 0) {  // as in UTM: single precision has units of 1/16 and 1/2 there
    shape.scale = 30;
    shape.offset = 500'000;
  }
  Pslg input = oracles::make_random_pslg(seed, shape).input;
  const auto count = static_cast<std::int32_t>(input.points.size());
  for (std::int32_t i = 0; i < count && seed % 2 == 0; ++i) input.point_markers.push_back(i % 4);
  for (std::int32_t i = 0; i < count && seed % 5 < 2; ++i) input.attributes.push_back(i / 8.0);
  input.attributes_per_point = input.attributes.empty() ? 0 : 1;
  return input;
}

}  // namespace

std::vector<MeshSample> make_mesh_samples() {
  std::vector<MeshSample> samples;
  const oracles::GridCase grid;
  samples.push_back({"grid", grid.input, grid.mesh});
  samples.push_back(meshed("triangle", ring({{0, 0}, {2, 0}, {0, 2}}), {}));
  samples.push_back(meshed("square", ring({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), {.max_area = 0.1}));
  samples.push_back(meshed("touching", touching(), {.max_area = 2}));
  samples.push_back(meshed("in-parts", touching(), {.max_area = 1, .subdomains = {.count = 4}}));
  Pslg points;
  points.points = {{0, 0}, {5, 1}, {6, 5}, {1, 6}, {3, 3}, {2, 4}, {4, 2}};
  samples.push_back(meshed("points", points, {.min_angle = 0}));
  for (std::uint64_t seed = 1; seed <= 18; ++seed)
    samples.push_back(meshed("random-" + std::to_string(seed), random_domain(seed),
                             {.min_angle = seed % 4 == 0 ? 15.0 : 0.0,
                              .region_areas = false,
                              .subdomains = {.count = seed % 5 == 0 ? 3 : 1}}));
  return samples;
}

}  // namespace driftmesh::mutants
