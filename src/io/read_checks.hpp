#pragma once

#include <string>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The likely cause of content that no writer would have written.
inline constexpr const char* kDamaged = "the file is damaged or was not written completely";

/// The last step of every reader: refuses what no mesh can hold (coordinates that are not finite or outside the range
/// of predicates.hpp, vertex indices out of range, arrays whose lengths disagree), and reverses all triangles if the
/// total area is negative. A single inverted triangle stays as it is, for a check to find. Error: InputError naming the
/// file.
void check_read_mesh(Mesh& mesh, const std::string& path);

/// Reverses all triangles if the total area is negative.
void make_counterclockwise(Mesh& mesh);

}  // namespace driftmesh
