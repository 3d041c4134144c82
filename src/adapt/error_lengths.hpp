#pragma once

#include <span>
#include <vector>

#include "adapt/generation.hpp"
#include "distributed/ranks.hpp"

namespace driftmesh::adapt {

/// See AdaptiveMesh::lengths_from_error. For the points of this rank's piece, the same on any number of ranks.
/// Collective.
[[nodiscard]] std::vector<double> lengths_from_error(const Generation& present, std::span<const double> indicators,
                                                     double target, double order, Ranks& ranks);

}  // namespace driftmesh::adapt
