#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/mesh_formats.hpp"
#include "io/triangle_data.hpp"
#include "io/vtu_format.hpp"

namespace driftmesh {

/// The format that the extension of `path` names; that of "-" and "/dev/null" is .vtu. Error: InputError for an unknown
/// extension, and for a standard stream where the format means several files.
[[nodiscard]] const MeshFormat& format_of(const std::string& path);

/// The extensions of what read_mesh reads, for messages and help: ".vtu, .pvtu, ... or .neigh".
[[nodiscard]] const std::string& mesh_files_read();
/// The extensions of what write_mesh or ranks write.
[[nodiscard]] const std::string& mesh_files_written();
/// The extensions of what write_mesh writes.
[[nodiscard]] const std::string& whole_mesh_files_written();
/// The same with what help says of each format: ".vtu (ParaView), ...".
[[nodiscard]] const std::string& mesh_files_described();

/// The extensions of the formats that have something, a member such as &MeshFormat::is_grid: ".14, .grd or .gr3".
[[nodiscard]] std::string mesh_files_with(bool MeshFormat::*something);

/// Whether the extension is that of a mesh and not of a domain as well, as .poly and .node are.
[[nodiscard]] bool is_mesh_file(const std::string& path);
/// Whether the extension is that of a mesh in pieces, of threads or ranks: .pvtu. Errors: as format_of.
[[nodiscard]] bool is_in_pieces(const std::string& path);
/// Whether only ranks can write it, each a file of its own: .pmesh. Errors: as format_of.
[[nodiscard]] bool is_for_ranks(const std::string& path);
/// Throws InputError if the format is only for pieces, which write_mesh does not write. Errors: as format_of.
void require_whole(const std::string& path);

/// The pieces of a mesh, not merged, with the numbers of their points, to be read one by one. Errors: as read_mesh.
class PieceFiles {
 public:
  explicit PieceFiles(const std::string& path, const ReadOptions& options = {});

  [[nodiscard]] std::size_t size() const;
  /// Piece `k`; `data`: those at triangles are put there, unless null. Threads may read at the same time.
  [[nodiscard]] Mesh read(std::size_t k, TriangleData* data = nullptr) const;
  /// The size of the largest one.
  [[nodiscard]] std::uint64_t most_bytes() const;

 private:
  std::vector<std::string> paths_;
  std::vector<DeclaredArray> arrays_;  // in every piece
};
/// All pieces.
[[nodiscard]] std::vector<Mesh> read_pieces(const std::string& path, const ReadOptions& options = {});

// The same as read_mesh and write_mesh, with data at triangles. A format that has no place for them gives none, and is
// written without, which WriteOptions::warn is told. write_mesh also throws InputError for names that no file can hold.
[[nodiscard]] Mesh read_mesh(const std::string& path, const ReadOptions& options, TriangleData& data);
void write_mesh(const Mesh& mesh, const TriangleData& data, const std::string& path, const WriteOptions& options);

/// The files that writing a mesh in so many pieces would replace; one in a single piece has 0. Errors: as format_of.
[[nodiscard]] std::vector<std::string> mesh_files(const std::string& path, std::int32_t pieces = 0);
/// The files that read_mesh would read. Errors: as read_mesh.
[[nodiscard]] std::vector<std::string> files_to_read(const std::string& path, const ReadOptions& options = {});

}  // namespace driftmesh
