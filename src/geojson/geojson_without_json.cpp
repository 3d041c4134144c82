#include "base/built_without.hpp"
#include "geojson/geojson.hpp"

namespace driftmesh {

GeoFeatures parse_geojson(const std::string& file, std::string_view /*text*/) {
  throw built_without("nlohmann-json", "JSON", file, "make a .poly of it");
}

}  // namespace driftmesh
