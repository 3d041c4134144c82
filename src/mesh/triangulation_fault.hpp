#pragma once

#include <string>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Looks whether arrays that came from elsewhere are a triangulation: every handle exists and is in use; live triangles
/// are counterclockwise and their neighbors know them; each leaf subsegment and its triangles know each other; the
/// subsegments are whole trees, one a root, of midpoints that lie where the formula puts them; free slots are listed
/// once each. Not asked: whether it is Delaunay, and whether it overlaps itself.
/// Returns what is wrong, empty if nothing is. Linear: about 9 ns a triangle, a tenth of the time
/// that refining took.
[[nodiscard]] std::string triangulation_fault(const Triangulation& mesh);

}  // namespace driftmesh
