#pragma once

#include <cstddef>
#include <vector>

#include "adapt/lineage.hpp"

namespace driftmesh::adapt {

/// Values at points, linear between them, at the points of the new mesh: `components` for each. A point that stays
/// keeps its bits. Collective.
[[nodiscard]] std::vector<double> interpolated_at_points(const Lineage& lineage, const std::vector<double>& old,
                                                         std::size_t components);

}  // namespace driftmesh::adapt
