#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh_piece.hpp"

namespace driftmesh {

/// Gmsh's format 4.1, binary. One curve entity and physical group for each marker of the constrained edges ("marker
/// 5"), one surface entity and physical group for each region ("region 2"; "domain" for a mesh without regions). A
/// group's tag is the value itself where that is a positive integer, otherwise a tag that is free; the name has the
/// exact value. Point attributes are $NodeData; point markers a section of our own, which other readers skip.
void write_msh(const MeshPiece& mesh, const std::string& path);

/// Reads format 4.1, ASCII or binary, as write_msh or Gmsh writes it: points, triangles and lines of first order, in
/// the order of their tags. Markers and regions are what the names of the physical groups say if write_msh wrote them,
/// otherwise the groups' tags, and 0 for what is in no group.
[[nodiscard]] MeshPiece read_msh(const std::string& path);
/// The same from memory; `file` is for messages.
[[nodiscard]] MeshPiece parse_msh(const std::string& file, std::string_view bytes);

}  // namespace driftmesh
