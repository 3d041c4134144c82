#pragma once

#include <string>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Looks whether arrays that came from elsewhere are a triangulation: every handle exists and is in use; live triangles
/// are counterclockwise and their neighbours know them; each leaf subsegment and its triangles know each other; the
/// subsegments are whole trees, one a root, of midpoints that lie where the formula puts them; free slots are listed
/// once each. Algorithms on such a triangulation stay within its arrays. Not asked: whether it is Delaunay, and whether
/// it overlaps itself.
/// Returns what is wrong, empty if nothing is. Linear; about as long as two copies of the arrays.
[[nodiscard]] std::string triangulation_fault(const Triangulation& mesh);

}  // namespace driftmesh
