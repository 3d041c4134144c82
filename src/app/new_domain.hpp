#pragma once

#include <string>

#include "driftmesh/mesh.hpp"
#include "job/watch.hpp"
#include "patch/new_outline.hpp"

namespace driftmesh::app {

/// Reads and repairs the domain that a mesh is to have from now on, in the coordinates of the mesh if these are known,
/// with markers and regions by its numbers. `tolerance`: 0: that of rounding. Throws what reading and repairing throw.
[[nodiscard]] patch::NewDomain read_new_domain(const std::string& file, double tolerance, Mesh& mesh,
                                               job::Watch& watch);

}  // namespace driftmesh::app
