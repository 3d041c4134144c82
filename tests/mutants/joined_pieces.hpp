#pragma once

#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh::mutants {

/// The points and triangles of all pieces, as merge_pieces orders them: a second opinion. Throws Undeclared where the
/// pieces contradict each other.
[[nodiscard]] Mesh joined(std::vector<Mesh> pieces);

}  // namespace driftmesh::mutants
