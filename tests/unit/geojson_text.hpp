#pragma once

#include <string>

#include "driftmesh/error.hpp"
#include "geojson/read_input.hpp"
#include "support/error_text.hpp"

// Texts of GeoJSON, and what is wrong with them.
namespace driftmesh::testing {

inline std::string error_of_text(const std::string& text) {
  return error_text<InputError>([&] { static_cast<void>(parse_geojson_input("coast.geojson", text)); });
}

inline std::string polygon(const std::string& rings, const std::string& properties = "{}") {
  return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": "Polygon", "coordinates": )" +
         rings + "}}";
}

}  // namespace driftmesh::testing
