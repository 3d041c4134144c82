#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/files.hpp"
#include "geojson/geojson.hpp"

namespace driftmesh {

/// Whether the file is GeoJSON by its name: .geojson or .json.
[[nodiscard]] bool is_geojson(const std::string& path);

/// read_input of GeoJSON in memory; `file` is for messages. `projection`: see project.
[[nodiscard]] InputFile parse_geojson_input(const std::string& file, std::string_view text,
                                            const std::string& projection = "");

/// The domain of features, projected if they are in degrees; `file` is for messages.
[[nodiscard]] InputFile input_of(const std::string& file, GeoFeatures features, const std::string& projection = "");

/// read_input of a file that holds no mesh.
[[nodiscard]] InputFile read_geometry(const std::string& path, const std::string& layers = "",
                                      const std::string& projection = "");

/// Projects a domain whose coordinates are degrees though its file does not say so. Throws as project does.
void project_degrees(InputFile& input, const std::string& projection, const std::string& file);

/// The files that read_geometry reads, or may read.
[[nodiscard]] std::vector<std::string> geometry_files(const std::string& path);

}  // namespace driftmesh
