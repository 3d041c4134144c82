#pragma once

#include <string>

namespace driftmesh {

/// All bytes of a file (or of a pipe). Throws FileError that names the file and the system's reason.
[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace driftmesh
