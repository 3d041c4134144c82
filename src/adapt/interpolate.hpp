#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "adapt/lineage.hpp"

namespace driftmesh::adapt {

/// Between the values at the corners of a triangle, and never beyond them. Weights are >= 0 and sum to 1.
[[nodiscard]] inline double interpolated(const std::array<double, 3>& weight, const std::array<double, 3>& at) {
  const auto [least, most] = std::minmax({at[0], at[1], at[2]});
  return std::clamp(weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2], least, most);
}

/// Values at points, linear between them, at the points of the new mesh: `components` for each. A point that stays
/// keeps its bits. Collective.
[[nodiscard]] std::vector<double> interpolated_at_points(const Lineage& lineage, const std::vector<double>& old,
                                                         std::size_t components);

}  // namespace driftmesh::adapt
