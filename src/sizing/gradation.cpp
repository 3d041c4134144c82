#include "sizing/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/triangle_geometry.hpp"
#include "sizing/lower_lengths.hpp"
#include "sizing/point_neighbors.hpp"

namespace driftmesh {

void limit_gradation(const std::vector<Point>& points, const std::vector<std::array<std::int32_t, 3>>& triangles,
                     double gradation, std::vector<double>& lengths) {
  const PointNeighbors neighbors(points.size(), triangles);
  const auto limit = [&](std::int32_t from, std::int32_t to) {
    return lengths[from] + gradation * std::sqrt(squared_distance(points[from], points[to]));
  };
  std::vector<std::pair<double, std::int32_t>> lowering;
  for (std::int32_t i = 0; i < neighbors.points(); ++i)
    if (std::ranges::any_of(neighbors.of(i),
                            [&](std::int32_t j) { return lengths[i] < lengths[j] && limit(i, j) < lengths[j]; }))
      lowering.emplace_back(lengths[i], i);
  const auto visit_neighbors = [&](std::int32_t i, const auto& visit) {
    std::ranges::for_each(neighbors.of(i), visit);
  };
  lower_lengths(std::move(lowering), lengths, visit_neighbors, limit);
}

}  // namespace driftmesh
