#pragma once

#include <cstdint>

#include "driftmesh/id_vector.hpp"
#include "mesh/corners.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// prepare_corners for a mesh in which some roots, one entry for each, stay as they are. They form no corners.
std::int32_t prepare_corners(Triangulation& mesh, const CornerUse& use, const IdVector<RootId, bool>& fixed);

}  // namespace driftmesh
