#pragma once

#include <string>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The native format of SU2, text: triangles, points, and a marker for each marker of the boundary, whose name is the
/// number. Markers of SU2 are boundaries of the domain, so subsegments inside of it are left out; it has no place for
/// regions and for data on points.
void write_su2(const Mesh& mesh, const std::string& path);

}  // namespace driftmesh
