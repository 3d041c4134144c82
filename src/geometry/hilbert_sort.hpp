#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/box.hpp"
#include "geometry/hilbert.hpp"

namespace driftmesh {

/// The indices of points in their order along a Hilbert curve, equal ones ascending.
[[nodiscard]] inline std::vector<std::size_t> in_hilbert_order(const std::vector<Point>& points) {
  std::vector<std::size_t> sorted;
  if (points.empty()) return sorted;
  const Box box = Box::of(points);
  const HilbertOrder order(box.low, box.high);
  std::vector<std::pair<std::uint64_t, std::size_t>> keyed;
  keyed.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) keyed.emplace_back(order.index(points[i]), i);
  std::sort(keyed.begin(), keyed.end());
  sorted.reserve(points.size());
  for (const auto& [index, i] : keyed) sorted.push_back(i);
  return sorted;
}

}  // namespace driftmesh
