#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh_piece.hpp"

namespace driftmesh {

/// One VTK unstructured grid: the triangles, then the constrained edges as line cells, as raw appended binary data.
/// Point data "marker" and "attribute"; cell data "marker" (0 on triangles) and "region" (of a triangle at it, on a
/// line); each only where the mesh has it.
void write_vtu(const MeshPiece& mesh, const std::string& path);

/// Reads what write_vtu writes; other files of that kind too, as long as they hold triangles and lines as raw
/// appended data that is not compressed.
[[nodiscard]] MeshPiece read_vtu(const std::string& path);
/// The same from memory; `file` is for messages.
[[nodiscard]] MeshPiece parse_vtu(const std::string& file, std::string_view bytes);

}  // namespace driftmesh
