#pragma once

#include <string>
#include <string_view>

#include "driftmesh/files.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// read_poly of a text; `file` is for messages and for finding the .node file.
[[nodiscard]] Pslg parse_poly(const std::string& file, std::string_view text);

}  // namespace driftmesh
