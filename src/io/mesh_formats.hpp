#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "io/mesh_parts.hpp"
#include "io/triangle_data.hpp"

namespace driftmesh {

/// Who can write a mesh as one file for each of its pieces.
enum class PieceWriters : std::uint8_t { kNobody, kThreadsAndRanks, kRanks };

/// A format of mesh files. A function that is null is something that the format does not need, or cannot do.
struct MeshFormat {
  std::vector<std::string_view> extensions;  ///< the first stands for the format
  std::string_view remark{};                 ///< for help: who reads it, or what is special
  MeshParts keeps = 0;                       ///< what is written, and comes back when it is read
  bool is_grid = false;     ///< open boundaries as in ADCIRC, and longitudes and latitudes if the domain has them
  bool has_text = false;    ///< WriteOptions::ascii chooses text instead of binary data
  bool has_ghosts = false;  ///< pieces may have triangles of their neighbors

  /// Null for pieces.
  void (*write)(const Mesh& mesh, const std::string& path, const WriteOptions& options) = nullptr;
  /// The mesh in the bytes of a file; `file` is for messages. Throws InputError.
  Mesh (*parse)(const std::string& file, std::string_view bytes) = nullptr;
  std::string_view begins{};  ///< the characters that such a file may begin with; empty: any
  /// Takes the place of `parse` for what is no sequence of bytes. Throws InputError, FileError.
  Mesh (*read)(const std::string& path, const ReadOptions& options) = nullptr;

  /// The same with what they have at triangles besides, and a mesh written with such data. Null: the format has no
  /// place for them.
  Mesh (*parse_with_data)(const std::string& file, std::string_view bytes, TriangleData& data) = nullptr;
  Mesh (*read_with_data)(const std::string& path, const ReadOptions& options, TriangleData& data) = nullptr;
  void (*write_with_data)(const Mesh& mesh, const TriangleData& data, const std::string& path,
                          const WriteOptions& options) = nullptr;

  /// The files of a mesh in so many pieces. Null: one file, which may be a standard stream.
  std::vector<std::string> (*files)(const std::string& path, std::int32_t pieces) = nullptr;
  /// The files that `read` reads. Null: all of `files`.
  std::vector<std::string> (*files_read)(const std::string& path, const ReadOptions& options) = nullptr;

  PieceWriters in_pieces = PieceWriters::kNobody;
  std::string_view whole{};  ///< for pieces: the extension of the format for whole meshes

  [[nodiscard]] bool is_read() const { return parse != nullptr || read != nullptr; }
};

/// All of them: the one list from which reading, writing, help and messages take what they know of formats.
[[nodiscard]] std::span<const MeshFormat> mesh_formats();

}  // namespace driftmesh
