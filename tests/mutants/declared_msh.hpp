#pragma once

#include <string>
#include <string_view>

#include "driftmesh/mesh.hpp"
#include "mutants/fields.hpp"

namespace driftmesh::mutants {

/// The mesh in a .msh of format 4.1: a second reader, which shares nothing with that in src/io. Notes the fields of
/// the file. Throws Undeclared.
[[nodiscard]] Mesh declared_msh(std::string_view bytes, Fields& fields);

/// A binary file as text.
[[nodiscard]] std::string msh_as_text(std::string_view binary);

}  // namespace driftmesh::mutants
