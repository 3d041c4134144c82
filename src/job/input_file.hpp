#pragma once

#include <string>
#include <vector>

#include "driftmesh/files.hpp"

namespace driftmesh {

/// The files that read_input reads, or may read.
[[nodiscard]] std::vector<std::string> input_files(const std::string& path);

}  // namespace driftmesh
