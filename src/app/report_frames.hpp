#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/file_registry.hpp"
#include "driftmesh/files.hpp"
#include "report/packed_frames.hpp"

namespace driftmesh::app {

/// Meshes in files that follow each other, for a page to play.
struct FrameFiles {
  struct One {
    std::string path;
    std::optional<double> time{};
  };
  std::string name;  ///< that they have in common: "flow_*.vtu"
  std::vector<One> files;
};

/// Whether the file holds frames, by its name: a mesh, or a .pvd that names some.
[[nodiscard]] bool holds_frames(const std::string& path);

/// Registers and lists the frames in files. Those whose names differ in numbers alone are in the order of these.
[[nodiscard]] FrameFiles list_frames(const std::vector<std::string>& paths, FileRegistry& registry,
                                     const ReadOptions& options);

/// Reads and packs all frames with a field at points or triangles; an empty name is that of the only one. Throws
/// InputError for frames that have not the field, or at another place than those before, and for more than
/// `most_triangles`.
[[nodiscard]] PackedFrames pack_frames(const FrameFiles& frames, const std::string& field, std::size_t most_triangles,
                                       const ReadOptions& options);

}  // namespace driftmesh::app
