#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adapt/lineage.hpp"
#include "driftmesh/adaptive.hpp"

namespace driftmesh::adapt {

/// Values that go from one mesh to the next.
struct Field {
  FieldPlace place = FieldPlace::kPoints;
  Transfer how = Transfer::kInterpolate;
  std::size_t components = 1;  ///< values at each place
  std::vector<double> values;
};

/// All values that a field has at a point, or in a triangle.
[[nodiscard]] inline std::size_t values_at(const Field& field) {
  return field.components * (field.place == FieldPlace::kCorners ? 3 : 1);
}

/// What of the old mesh is there in the new one.
struct Stayed {
  // For each point, or triangle, of the new mesh its number in the old one; -1: it is not there.
  std::vector<std::int32_t> points, triangles;
};

/// The values of the fields on the new mesh. All that is known of a subdomain is found once, for all fields, and
/// forgotten before the next one. Places whose triangles stay keep their bits. Values stay between the least and the
/// largest of those that they come from.
///
/// What is interpolated is linear between points. What is conserved: what an old triangle holds is divided among the
/// new triangles that overlap it. At triangles: the mean of what a triangle overlaps. At corners: the L2 projection,
/// brought closer to its mean where it would exceed what it overlaps. At points: interpolation, brought closer to the
/// lumped projection (Farrell and others 2009) just as far as conserves the integral, where that moves it in the right
/// direction; exact for a linear field.
///
/// `stayed`: if not null, where what stayed is noted. Collective.
[[nodiscard]] std::vector<std::vector<double>> transferred(const Lineage& lineage, std::span<const Field* const> fields,
                                                           Stayed* stayed = nullptr);

}  // namespace driftmesh::adapt
