#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/files.hpp"

namespace driftmesh {

/// Whether the file is GeoJSON by its name: .geojson or .json.
[[nodiscard]] bool is_geojson(const std::string& path);

/// read_input of GeoJSON in memory; `file` is for messages.
[[nodiscard]] InputFile parse_geojson_input(const std::string& file, std::string_view text);

/// The files that read_input reads, or may read.
[[nodiscard]] std::vector<std::string> input_files(const std::string& path);

}  // namespace driftmesh
