#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh::testing {

struct FlatMesh {
  std::vector<Point> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// The square from (0, 0) to (n, n) without the middle hole cells each way: points of a grid, those inside shifted by
/// up to 0.3 where `jitter`; diagonals and orientations by chance; triangles in any order.
inline FlatMesh square_mesh(int n, int hole = 0, bool jitter = true, std::uint64_t seed = 11) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  const int hole_low = (n - hole) / 2, hole_high = hole_low + hole;
  const auto on_rim = [&](int i, int j) {
    const bool outer = i == 0 || j == 0 || i == n || j == n;
    return outer || (hole > 0 && i >= hole_low && i <= hole_high && j >= hole_low && j <= hole_high);
  };
  FlatMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool moved = jitter && !on_rim(i, j);
      mesh.points.push_back({i + (moved ? shift(random) : 0), j + (moved ? shift(random) : 0)});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (i >= hole_low && i < hole_high && j >= hole_low && j < hole_high) continue;
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (random() % 2)
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, d, c}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {{b, d, a}, {b, c, d}});
    }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

}  // namespace driftmesh::testing
