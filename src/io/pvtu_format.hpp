#pragma once

#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/vtu_format.hpp"

namespace driftmesh {

/// The name of piece `k` of the .pvtu at `path`, in the same folder: mesh.pvtu has mesh_0.vtu, mesh_1.vtu, ...
[[nodiscard]] std::string pvtu_piece_path(const std::string& path, std::int32_t k);

/// Writes the .pvtu that names `pieces` pieces, which have been written with the given arrays.
void write_pvtu(const std::string& path, std::int32_t pieces, const VtuArrays& arrays);

/// What a .pvtu says.
struct Pvtu {
  std::vector<std::string> pieces;    ///< their paths
  std::vector<DeclaredArray> arrays;  ///< in every piece
};

/// Throws InputError for what is damaged, and for a piece outside of the file's folder, unless that is allowed.
[[nodiscard]] Pvtu read_pvtu_header(const std::string& path, const ReadOptions& options = {});
/// The same from memory; `file` is for messages, and its folder is where the pieces are.
[[nodiscard]] Pvtu parse_pvtu(const std::string& file, std::string_view bytes, const ReadOptions& options = {});

/// The whole mesh of a .pvtu (see merge_pieces). `data`: those at triangles that all pieces have are put there, unless
/// null. Throws InputError if its pieces contradict each other.
[[nodiscard]] Mesh read_pvtu(const std::string& path, const ReadOptions& options = {}, TriangleData* data = nullptr);

}  // namespace driftmesh
