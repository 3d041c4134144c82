#pragma once

#include "driftmesh/pslg.hpp"
#include "verify/findings.hpp"
#include "verify/point_index.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// Points of the input have its markers and its attributes to the last bit, as far as the mesh lists them. Where the
/// input has marker 0, the marker of a subsegment at the point is accepted, and 1 at any subsegment, as other programs
/// mark boundaries.
void check_point_data(const NamedMesh& mesh, const Pslg& input, const PointIndex& mesh_points, Findings& findings);

}  // namespace driftmesh
