#pragma once

#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh::adapt {

/// See AdaptiveMesh::lengths_from_error.
[[nodiscard]] std::vector<double> lengths_from_error(const Mesh& mesh, std::span<const double> indicators,
                                                     double target, double order);

}  // namespace driftmesh::adapt
