#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace driftmesh::testing {

/// So many values between -1 and 1, no two of them alike.
[[nodiscard]] inline std::vector<double> waves(std::size_t count, double frequency) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(std::sin(frequency * static_cast<double>(i)));
  return values;
}

}  // namespace driftmesh::testing
