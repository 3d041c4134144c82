#pragma once

#include <optional>
#include <string>

#include "adapt/saved.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/triangle_data.hpp"

namespace driftmesh::app {

/// What read_any_mesh reads, for help: ".vtu, ... or .neigh, or a saved adaptive mesh".
[[nodiscard]] std::string mesh_inputs();

/// Whether the file is a saved adaptive mesh, whatever its name.
[[nodiscard]] bool is_saved_session(const std::string& path);

/// Reads a mesh file as read_mesh does, or a saved adaptive mesh. Fields at points, and depths from the rasters of the
/// session, are attributes of the mesh, called as they are; those with several components are one each, called u_0,
/// u_1. What has no place there is a warning. Errors: as read_mesh; InputError, FileError for the rasters.
[[nodiscard]] Mesh read_any_mesh(const std::string& path, const ReadOptions& options);
/// The same with data at triangles, of a session fields there.
[[nodiscard]] Mesh read_any_mesh(const std::string& path, const ReadOptions& options, TriangleData& data);

/// A mesh as a file has it.
struct MeshInput {
  Mesh mesh;
  std::optional<adapt::SavedHead> session{};  ///< what a saved adaptive mesh has besides, with the values of its fields
};

/// The same for a judge: from this file alone, with fields beside the mesh.
[[nodiscard]] MeshInput read_to_check(const std::string& path, const ReadOptions& options);

}  // namespace driftmesh::app
