#pragma once

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Makes land of open boundaries shorter than options.open_from: their edges get a marker that no other edge has, and
/// that is not open (see EdgeTypes). The mesh must be in a plane.
void close_short_openings(Mesh& mesh, const WriteOptions& options);

}  // namespace driftmesh
