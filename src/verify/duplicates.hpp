#pragma once

#include <functional>

#include "verify/findings.hpp"
#include "verify/point_index.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// Whether a point of a mesh counts.
using PointFilter = std::function<bool(std::int32_t)>;

/// Adds the points that count to `index`, an index of the mesh's points, and to the findings those that have the
/// coordinates of an earlier one, if `is_new` holds for at least one of the two.
void check_duplicates(const NamedMesh& mesh, const PointFilter& counts, const PointFilter& is_new, PointIndex& index,
                      Findings& findings);

}  // namespace driftmesh
