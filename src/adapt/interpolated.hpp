#pragma once

#include <algorithm>
#include <array>

namespace driftmesh::adapt {

/// Between the values at the corners of a triangle, and never beyond them. Weights are >= 0 and sum to 1.
[[nodiscard]] inline double interpolated(const std::array<double, 3>& weight, const std::array<double, 3>& at) {
  const auto [least, most] = std::minmax({at[0], at[1], at[2]});
  return std::clamp(weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2], least, most);
}

}  // namespace driftmesh::adapt
