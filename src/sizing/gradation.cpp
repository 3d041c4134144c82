#include "sizing/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// The points that each point shares an edge with, in one array: those of point i from begin[i] to begin[i + 1]. Most
/// appear twice, once for each triangle on the edge.
struct Neighbors {
  std::vector<std::size_t> begin;
  std::vector<std::int32_t> points;
};

Neighbors neighbors_along_edges(std::size_t point_count, const std::vector<std::array<std::int32_t, 3>>& triangles) {
  Neighbors result;
  result.begin.assign(point_count + 1, 0);
  for (const auto& triangle : triangles)
    for (const std::int32_t corner : triangle) result.begin[corner + 1] += 2;
  for (std::size_t i = 0; i < point_count; ++i) result.begin[i + 1] += result.begin[i];
  result.points.resize(result.begin.back());
  std::vector<std::size_t> next(result.begin.begin(), result.begin.end() - 1);
  for (const auto& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::size_t other : {(i + 1) % 3, (i + 2) % 3}) result.points[next[triangle[i]]++] = triangle[other];
  return result;
}

}  // namespace

void limit_gradation(const std::vector<Point>& points, const std::vector<std::array<std::int32_t, 3>>& triangles,
                     double gradation, std::vector<double>& lengths) {
  const Neighbors neighbors = neighbors_along_edges(points.size(), triangles);
  // Dijkstra's algorithm from all points that lower another: the shortest length is final and limits those around it.
  using Entry = std::pair<double, std::size_t>;
  std::vector<Entry> lowering;
  const auto limit_from = [&](std::size_t i, std::size_t j) {
    return lengths[i] + gradation * std::sqrt(squared_distance(points[i], points[j]));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto begin = neighbors.points.begin();
    const auto lowers = [&](std::int32_t j) {
      return lengths[i] < lengths[j] && limit_from(i, static_cast<std::size_t>(j)) < lengths[j];
    };
    if (std::any_of(begin + static_cast<std::ptrdiff_t>(neighbors.begin[i]),
                    begin + static_cast<std::ptrdiff_t>(neighbors.begin[i + 1]), lowers))
      lowering.emplace_back(lengths[i], i);
  }
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>{}, std::move(lowering));
  while (!queue.empty()) {
    const auto [length, i] = queue.top();
    queue.pop();
    if (length > lengths[i]) continue;
    for (std::size_t k = neighbors.begin[i]; k < neighbors.begin[i + 1]; ++k) {
      const std::int32_t j = neighbors.points[k];
      const double limit = length + gradation * std::sqrt(squared_distance(points[i], points[j]));
      if (limit >= lengths[j]) continue;
      lengths[j] = limit;
      queue.emplace(limit, j);
    }
  }
}

}  // namespace driftmesh
