#pragma once

#include <cstddef>
#include <string>

#include "driftmesh/files.hpp"

namespace driftmesh {

/// The path of a file that another one names on a line, from its own folder; `words` are what it is there: "piece".
/// Throws InputError if it lies elsewhere, unless that is allowed.
[[nodiscard]] std::string file_beside(const std::string& file, std::size_t line, const std::string& words,
                                      const std::string& name, const ReadOptions& options);

}  // namespace driftmesh
