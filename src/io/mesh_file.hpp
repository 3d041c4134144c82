#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/vtu_format.hpp"

namespace driftmesh {

/// The files that read_mesh reads, for messages and help: "the mesh: .vtu, .pvtu, ... or .neigh".
[[nodiscard]] const std::string& mesh_files_read();
/// Those that write_mesh writes, or ranks.
[[nodiscard]] const std::string& mesh_files_written();

/// Whether the extension is that of a mesh and not of a domain as well, as .poly and .node are.
[[nodiscard]] bool is_mesh_file(const std::string& path);
/// Whether the extension is that of a mesh in pieces: .pvtu. Error: InputError for an unknown extension.
[[nodiscard]] bool is_in_pieces(const std::string& path);
/// Whether only ranks can write it, each a file of its own: .pmesh. Error: as is_in_pieces.
[[nodiscard]] bool is_for_ranks(const std::string& path);
/// Whether ranks write it together, so that none of them has the whole mesh: .pvtu, .h5 and .pmesh. Error: as
/// is_in_pieces.
[[nodiscard]] bool is_written_by_all(const std::string& path);
/// The pieces of a mesh, not merged, with the numbers of their points, to be read one by one. Errors: as read_mesh.
class PieceFiles {
 public:
  explicit PieceFiles(const std::string& path, const ReadOptions& options = {});

  [[nodiscard]] std::size_t size() const;
  /// Piece `k`. Threads may read at the same time.
  [[nodiscard]] Mesh read(std::size_t k) const;
  /// Of the largest one.
  [[nodiscard]] std::uint64_t most_bytes() const;

 private:
  std::vector<std::string> paths_;
  std::vector<DeclaredArray> arrays_;  // which every piece has
};
/// All pieces.
[[nodiscard]] std::vector<Mesh> read_pieces(const std::string& path, const ReadOptions& options = {});

/// The files that write_mesh would replace. Error: InputError for an unknown extension.
[[nodiscard]] std::vector<std::string> mesh_files(const std::string& path);
/// The files that read_mesh would read. Errors: as read_mesh.
[[nodiscard]] std::vector<std::string> files_to_read(const std::string& path, const ReadOptions& options = {});

}  // namespace driftmesh
