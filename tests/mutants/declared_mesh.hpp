#pragma once

#include <string>

#include "driftmesh/mesh.hpp"

namespace driftmesh::mutants {

/// Reverses all triangles if their total area is negative, as docs/file-formats.md says of files in all formats.
void turn_if_seen_from_below(Mesh& mesh);

/// In what two meshes differ, "" if in nothing. Numbers are compared by their bits; all NaN are equal.
[[nodiscard]] std::string difference(const Mesh& read, const Mesh& declared);

}  // namespace driftmesh::mutants
