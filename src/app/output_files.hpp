#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace driftmesh::app {

/// The files written for a mesh at `path` by this number of ranks: a .pvtu has one piece per rank.
[[nodiscard]] std::vector<std::string> files_of_output(const std::string& path, std::int32_t ranks);

/// Throws before the work starts if writing would fail after it: for an unknown extension, a folder that is missing or
/// not writable, a duplicate file, or one that would overwrite the input. `meshes` are mesh files for write_mesh, or
/// .pvtu if there are `ranks`; `picture` and `record` may be empty.
void check_outputs(const std::vector<std::string>& meshes, const std::string& picture, const std::string& record,
                   const std::string& input, std::int32_t ranks = 0);

}  // namespace driftmesh::app
