#include "geojson/read_input.hpp"

#include <filesystem>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "geojson/geojson.hpp"
#include "geojson/rings_to_pslg.hpp"
#include "gis/vector_file.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh {

bool is_geojson(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".geojson" || extension == ".json";
}

bool holds_input(const std::string& path) {
  const std::filesystem::path name(path);
  if (name.extension() != ".node") return name.extension() == ".poly" || is_geojson(path) || is_vector_file(path);
  return !std::filesystem::exists(std::filesystem::path(path).replace_extension(".ele"));
}

InputFile parse_geojson_input(const std::string& file, std::string_view text) {
  GeoFeatures features = parse_geojson(file, text);
  InputFile input;
  input.projection = features.in_degrees ? project(features, file) : features.projection;
  input.pslg = to_pslg(features);
  return input;
}

InputFile read_geometry(const std::string& path, const std::string& layers) {
  if (is_vector_file(path)) return parse_geojson_input(path, vector_as_geojson(path, layers));
  if (!layers.empty()) throw InputError({path}, "has no layers", "name layers of files that have some, such as .gpkg");
  if (is_geojson(path)) return parse_geojson_input(path, read_file(path));
  return {read_poly(path), {}};
}

std::vector<std::string> geometry_files(const std::string& path) {
  if (is_geojson(path)) return {path};
  if (is_vector_file(path)) return vector_files(path);
  return poly_files(path);
}

}  // namespace driftmesh
