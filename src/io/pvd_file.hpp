#pragma once

#include <string>
#include <vector>

#include "driftmesh/files.hpp"

namespace driftmesh {

/// A mesh of a series, and its moment.
struct PvdMesh {
  double time = 0;
  std::string path;
};

/// The meshes that a .pvd of ParaView names, by time. Throws InputError for what is damaged, one without meshes, a
/// moment with several parts, and a file outside of the .pvd's folder, unless that is allowed.
[[nodiscard]] std::vector<PvdMesh> read_pvd(const std::string& path, const ReadOptions& options = {});

}  // namespace driftmesh
