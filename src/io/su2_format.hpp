#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

// VTK's numbers of cell types, which SU2 uses.
inline constexpr std::int32_t kSu2Line = 3;
inline constexpr std::int32_t kSu2Triangle = 5;
/// What a comment begins with that tells the number of a marker, its tag in the file, which is one word, and its name.
inline constexpr std::string_view kSu2NameComment = "% driftmesh marker ";

/// What a comment begins with that tells what the coordinates of points are (see Mesh).
inline constexpr std::string_view kSu2Coordinates = "% driftmesh coordinates ";

/// The native format of SU2, text: triangles, points, and a marker for each marker of the boundary, called by its name,
/// or else by its number. Where names have characters with a meaning in settings of SU2, these become '_'. Comments at
/// the beginning say which marker each name is for. Markers of SU2 are boundaries of the domain, so subsegments inside
/// of it are left out; it has no place for regions and for data on points.
void write_su2(const Mesh& mesh, const std::string& path);

/// Reads what write_su2 writes, and planar meshes of triangles from other programs, in one zone. Markers that are
/// called by a number have that number; other ones the number that a comment gives them, or the lowest that are free,
/// and a name. `file` is for messages. Throws InputError.
[[nodiscard]] Mesh parse_su2(const std::string& file, std::string_view text);

}  // namespace driftmesh
