#pragma once

#include <string>
#include <string_view>

#include "driftmesh/mesh.hpp"
#include "mutants/fields.hpp"

// What VTK's files declare: a second reader, which shares nothing with that in src/io. Both functions throw Undeclared.

namespace driftmesh::mutants {

/// The mesh in a .vtu. Notes its fields.
[[nodiscard]] Mesh declared_vtu(std::string_view bytes, Fields& fields);

/// The mesh in the .pvtu NAME and its pieces.
[[nodiscard]] Mesh declared_pvtu(const Files& files, const std::string& name);

}  // namespace driftmesh::mutants
