#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

// The grid of ADCIRC (fort.14, .14, .grd) and SCHISM (hgrid.gr3, .gr3), text: a title, the counts of elements and
// nodes, nodes with their depths, triangles, open boundaries, land boundaries (ADCIRC user manual, "Grid and Boundary
// Information File"; SCHISM manual, "hgrid.gr3"). Numbers start at 1. There is no place for regions and for segments
// inside of the domain.

/// The markers that edges have which are read, since the format knows types of boundaries instead. Those of other types
/// are this much more than the type. All but land and islands have the name of the type (boundary_types.hpp).
inline constexpr std::int32_t kLandMarker = 1;
inline constexpr std::int32_t kIslandMarker = 2;
inline constexpr std::int32_t kOpenMarker = 3;
inline constexpr std::int32_t kTypeMarkers = 100;
inline constexpr std::int32_t kPartMarkers = 10'000;

/// What the title of a grid begins with; what its coordinates are (see Mesh) follows.
inline constexpr const char* kFort14Title = "driftmesh";

/// Boundaries have the types that the names of their markers say; without one, rings inside of the domain are islands
/// (type 1), everything else is mainland (type 0). Of `options`, those about boundaries count. Strings are as
/// boundary_of makes them. `has_weirs`: false for SCHISM, which has none. The first attribute of a point is its depth;
/// 0 without attributes.
void write_fort14(const Mesh& mesh, const std::string& path, const WriteOptions& options, bool has_weirs);

/// Reads what write_fort14 writes, and grids of triangles from other programs. The depth becomes the attribute of the
/// points, unless it is 0 everywhere. Boundaries become edges with the markers above, those of weirs on both sides.
/// `file` is for messages. Throws InputError.
[[nodiscard]] Mesh parse_fort14(const std::string& file, std::string_view text);

}  // namespace driftmesh
