#pragma once

#include <cstddef>
#include <vector>

#include "adapt/lineage.hpp"

namespace driftmesh::adapt {

// Transfer that conserves integrals: what an old triangle holds is divided among the new triangles that overlap it. All
// return `components` values for each place of the new mesh. Values stay between the least and the largest of those
// that they come from.

/// One value for each triangle, the mean of what it overlaps. A triangle that stays keeps its bits.
[[nodiscard]] std::vector<double> conserved_at_triangles(const Lineage& lineage, const std::vector<double>& old,
                                                         std::size_t components);

/// Three values for each triangle, one for each corner: the L2 projection, brought closer to its mean where it would
/// exceed what it overlaps. A triangle that stays keeps its bits.
[[nodiscard]] std::vector<double> conserved_at_corners(const Lineage& lineage, const std::vector<double>& old,
                                                       std::size_t components);

/// Values at points, linear between them: interpolation, brought closer to the lumped projection (Farrell and others
/// 2009) just as far as conserves the integral, where that moves it in the right direction. Exact for a linear field. A
/// point all of whose triangles stay keeps its bits.
[[nodiscard]] std::vector<double> conserved_at_points(const Lineage& lineage, const std::vector<double>& old,
                                                      std::size_t components);

}  // namespace driftmesh::adapt
