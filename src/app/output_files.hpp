#pragma once

#include <string>
#include <vector>

namespace driftmesh::app {

/// Throws before the work starts for what would fail after it: an unknown extension, a folder that does not exist or
/// cannot be written to, one file named twice, a file of the input that would be replaced. `meshes` are mesh files as
/// write_mesh takes them; `picture` and `record` may be empty.
void check_outputs(const std::vector<std::string>& meshes, const std::string& picture, const std::string& record,
                   const std::string& input);

}  // namespace driftmesh::app
