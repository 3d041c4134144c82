#pragma once

#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "job/request.hpp"

namespace driftmesh {

namespace job {

/// read_input as a request wants it: with its layers, projection, and degrees that the file does not tell of. Throws as
/// read_input does.
[[nodiscard]] InputFile read_domain_file(const std::string& path, const Request::Input& asked);

}  // namespace job

/// The files that read_input reads, or may read.
[[nodiscard]] std::vector<std::string> input_files(const std::string& path);

}  // namespace driftmesh
