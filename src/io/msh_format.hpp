#pragma once

#include <string>
#include <string_view>

#include "driftmesh/mesh.hpp"
#include "io/triangle_data.hpp"

namespace driftmesh {

/// Gmsh's format 4.1, binary or ASCII. One curve entity and physical group for each marker of the constrained edges
/// ("marker 5"), one surface entity and physical group for each region ("region 2"; "domain" for a mesh without
/// regions). A group's tag is the value itself if that is a positive integer, otherwise one from 1000000 on, which is
/// that of 0 (see group_tags); its name holds the exact value. Point attributes are $NodeData, `data` $ElementData;
/// point markers are in a section of our own, which other readers skip.
void write_msh(const Mesh& mesh, const TriangleData& data, const std::string& path, bool ascii = false);

/// Reads format 4.1, ASCII or binary, as written by write_msh or Gmsh: points, triangles and lines of first order, in
/// the order of their tags. Markers and regions come from the names of the physical groups if write_msh wrote them,
/// otherwise from the groups' tags; they are 0 for elements in no group. `file` is for messages.
[[nodiscard]] Mesh parse_msh(const std::string& file, std::string_view bytes);
/// The same, with the views on elements that have a value for each triangle.
[[nodiscard]] Mesh parse_msh(const std::string& file, std::string_view bytes, TriangleData& data);

}  // namespace driftmesh
