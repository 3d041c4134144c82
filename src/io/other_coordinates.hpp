#pragma once

#include <string>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/mesh_formats.hpp"

namespace driftmesh {

// What coordinates a file has (WriteOptions::crs), besides codes and kLonLat (gis/coordinates.hpp).
inline constexpr const char* kByFormat = "auto";
inline constexpr const char* kProjected = "projected";

/// What a file has coordinates in, if not those of the mesh's plane: "lonlat", or a code such as "EPSG:3035". Empty: in
/// the plane. Throws InputError where others are asked for, but those of the mesh are not known.
[[nodiscard]] std::string coordinates_wanted(const Mesh& mesh, const std::string& path, const WriteOptions& options);

/// Moves all points of a mesh that is in a plane to such coordinates, and says so in Mesh::coordinates. `path` is for
/// messages. Throws InputError.
void change_coordinates(Mesh& mesh, const std::string& wanted, const std::string& path);

/// The inverse, for a mesh from a file: nothing is done if it is in a plane. What is not known in Mesh::coordinates is
/// left out.
void return_to_plane(Mesh& mesh, const std::string& path);

}  // namespace driftmesh
