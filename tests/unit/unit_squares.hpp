#pragma once

#include <cstdint>

#include "driftmesh/mesh.hpp"

namespace driftmesh::testing {

/// Columns and rows of unit squares, each of two triangles: below its diagonal first, then above it. Rows
/// begin below, points and squares on the left.
[[nodiscard]] inline Mesh unit_squares(std::int32_t columns, std::int32_t rows) {
  Mesh mesh;
  for (std::int32_t y = 0; y <= rows; ++y)
    for (std::int32_t x = 0; x <= columns; ++x) mesh.points.push_back({static_cast<double>(x), static_cast<double>(y)});
  for (std::int32_t y = 0; y < rows; ++y)
    for (std::int32_t x = 0; x < columns; ++x) {
      const std::int32_t a = y * (columns + 1) + x, b = a + columns + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

}  // namespace driftmesh::testing
