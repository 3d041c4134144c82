#pragma once

#include <string>

#include "mesh/mesh_piece.hpp"

namespace driftmesh {

/// The likely cause of what no writer would have written.
inline constexpr const char* kDamaged = "the file is damaged or was not written completely";

/// The last step of every reader: refuses what no mesh can hold (coordinates that are not finite or beyond the range of
/// predicates.hpp, vertex indices out of range, arrays whose lengths disagree) and turns over a mesh whose area is
/// negative as a whole. A single triangle that is inverted stays as it is, for a check to find. Error: InputError
/// naming the file.
void check_read_mesh(MeshPiece& mesh, const std::string& path);

}  // namespace driftmesh
