#pragma once

#include <string_view>

#include "driftmesh/mesh.hpp"

namespace driftmesh::mutants {

/// The mesh in a .su2: a second reader, which shares nothing with that in src/io. Names of markers are left out. Throws
/// Undeclared.
[[nodiscard]] Mesh declared_su2(std::string_view text);

}  // namespace driftmesh::mutants
