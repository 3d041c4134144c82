#pragma once

#include <string>

namespace driftmesh {

/// All bytes of a file, of a pipe, or of standard input (see is_standard_stream), which can be read only once. Throws
/// FileError that names the file and the system's reason, and InputError for reading standard input again.
[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace driftmesh
