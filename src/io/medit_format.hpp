#pragma once

#include <string>
#include <string_view>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The text format of Medit ("Medit: an interactive mesh visualization software", Frey 2001), which mmg2d, FreeFEM and
/// others read: points and triangles with references, and all constrained subsegments as edges. References of points
/// and edges are their markers, those of triangles the tags of their regions, or 0 without regions; comments say what
/// each tag is for. Point attributes have no place in it.
void write_medit(const Mesh& mesh, const std::string& path);

/// Reads what write_medit writes, and planar meshes of triangles from other programs: of two dimensions, or of three
/// with all points at z = 0. Other sections, as of corners, tangents and required edges, are left out. References of
/// triangles become regions unless all are 0, as those of points become markers. `file` is for messages. Throws
/// InputError.
[[nodiscard]] Mesh parse_medit(const std::string& file, std::string_view text);

}  // namespace driftmesh
