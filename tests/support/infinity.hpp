#pragma once

#include <limits>

namespace driftmesh::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace driftmesh::testing
