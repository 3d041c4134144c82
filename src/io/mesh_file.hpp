#pragma once

#include <string>
#include <vector>

#include "mesh/mesh_piece.hpp"

namespace driftmesh {

/// What a mesh file may hold in addition to the mesh.
struct WriteOptions {
  std::vector<Point> holes;  ///< a point in each hole, for Triangle's .poly; other formats need none
};

/// Writes the mesh in the format that the extension of `path` names: .vtu, .msh, or Triangle's .node, .ele, .poly,
/// .edge, .neigh (any of these names the whole set); to standard output for "-" (as .vtu), "-.vtu" and "-.msh".
/// Files appear under their names only when complete. docs/file-formats.md says what each format holds. Errors:
/// InputError for an unknown extension, FileError.
void write_mesh(const MeshPiece& mesh, const std::string& path, const WriteOptions& options = {});

/// Reads a mesh back, from any of these formats, from standard input by the same names, or from the pieces that a .pvtu
/// names. Everything is checked before it is used: indices are in range and counts fit the file. Triangles stay as the
/// file lists them, so that a check sees what the file holds; only if the total area is negative are all of them
/// reversed. Errors: InputError naming file and place, FileError.
[[nodiscard]] MeshPiece read_mesh(const std::string& path);

/// Whether the extension is that of a mesh in pieces: .pvtu. Error: InputError for an unknown extension.
[[nodiscard]] bool is_in_pieces(const std::string& path);
/// The pieces of a mesh, not merged, with the numbers of their points, for a check. Errors: as read_mesh.
[[nodiscard]] std::vector<MeshPiece> read_pieces(const std::string& path);

/// The files that write_mesh would replace. Error: InputError for an unknown extension.
[[nodiscard]] std::vector<std::string> mesh_files(const std::string& path);
/// The files that read_mesh would read. Errors: as read_mesh.
[[nodiscard]] std::vector<std::string> files_to_read(const std::string& path);

}  // namespace driftmesh
