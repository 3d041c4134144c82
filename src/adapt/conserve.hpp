#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adapt/lineage.hpp"
#include "driftmesh/adaptive.hpp"

namespace driftmesh::adapt {

/// Values on the old mesh whose integrals are to stay. They must outlive the call.
struct ConservedField {
  FieldPlace place = FieldPlace::kPoints;
  std::size_t components = 1;  ///< values at each place
  const std::vector<double>& old;
};

/// The values of the fields on the new mesh: what an old triangle holds is divided among the new triangles that overlap
/// it, which are found once for all fields. Values stay between the least and the largest of those that they come from;
/// places whose triangles stay keep their bits.
///
/// At triangles: the mean of what a triangle overlaps. At corners: the L2 projection, brought closer to its mean where
/// it would exceed what it overlaps. At points, linear between them: interpolation, brought closer to the lumped
/// projection (Farrell and others 2009) just as far as conserves the integral, where that moves it in the right
/// direction; exact for a linear field. Collective.
[[nodiscard]] std::vector<std::vector<double>> conserved(const Lineage& lineage,
                                                         std::span<const ConservedField> fields);

}  // namespace driftmesh::adapt
