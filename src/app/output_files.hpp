#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace driftmesh::app {

/// The files that writing a mesh to `path` makes, with so many ranks: a .pvtu has a piece of each.
[[nodiscard]] std::vector<std::string> files_of_output(const std::string& path, std::int32_t ranks);

/// Throws before the work starts for what would fail after it: an unknown extension, a folder that does not exist or
/// cannot be written to, one file named twice, a file of the input that would be replaced. `meshes` are mesh files as
/// write_mesh takes them, and .pvtu if there are `ranks`; `picture` and `record` may be empty.
void check_outputs(const std::vector<std::string>& meshes, const std::string& picture, const std::string& record,
                   const std::string& input, std::int32_t ranks = 0);

}  // namespace driftmesh::app
