#pragma once

#include <cstdint>
#include <map>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// For the subdomains of a piece, the index that each vertex of their meshes has among the points of the piece; kNone
/// for free slots.
using PiecePlaces = std::map<SubdomainId, IdVector<VertexId, std::int32_t>>;

}  // namespace driftmesh
