#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verify/stayed.hpp"

namespace driftmesh::app {

/// Writes the numbers that are new, or are not what they were, in lines "point,NEW,OLD" and "triangle,NEW,OLD". Throws
/// FileError.
void write_number_map(const std::string& path, const std::vector<std::int32_t>& old_points,
                      const std::vector<std::int32_t>& old_triangles);

/// Reads such a file. Throws FileError, and InputError that names the line.
[[nodiscard]] NumberMap read_number_map(const std::string& path);

}  // namespace driftmesh::app
