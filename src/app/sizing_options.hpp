#pragma once

#include <string>
#include <vector>

#include "cli/command.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::app {

/// The options that ask for sizes of triangles (--size and so on), under a heading of help. `sizing` must outlive them.
[[nodiscard]] std::vector<cli::Option> sizing_options(SizingOptions& sizing, const std::string& group);

/// Throws UsageError for sizing options that do not go together.
void check_sizing_options(const SizingOptions& sizing);

}  // namespace driftmesh::app
