#include "geojson/read_input.hpp"

#include <cmath>
#include <filesystem>
#include <utility>

#include "base/read_file.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "geojson/choose_projection.hpp"
#include "geojson/dateline.hpp"
#include "geojson/each_point.hpp"
#include "geojson/geojson.hpp"
#include "geojson/rings_to_pslg.hpp"
#include "gis/geographic_system.hpp"
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

namespace {

/// Whether plane coordinates could as well be longitudes and latitudes.
bool could_be_degrees(GeoFeatures& features) {
  bool could_be = true;
  for_each_point(features, [&](const Point& p) { could_be = could_be && std::abs(p.x) <= 180 && std::abs(p.y) <= 90; });
  return could_be;
}

/// Of coordinates that go for those of a plane because their system is known neither as one of degrees nor as one of
/// meters; empty: there is nothing to say.
std::string warning_of_system(GeoFeatures& features) {
  if (features.in_degrees || !features.projection.empty() || features.system == kInMeters) return "";
  const std::string taken = "coordinates in the system '" + features.system + "' are taken for those of a plane";
  if (could_be_degrees(features))
    return taken + ", but look like degrees; if they are, convert the file: ogr2ogr -t_srs EPSG:4326";
  if (features.knows_system() || features.system == kUnsaid) return "";
  return taken + " in meters, since it is not known" + (can_read_vectors() ? "" : " without GDAL");
}

}  // namespace

InputFile input_of(const std::string& file, GeoFeatures features, const std::string& projection) {
  InputFile input;
  input.warnings = features.warnings;
  if (std::string warning = warning_of_system(features); !warning.empty()) input.warnings.push_back(std::move(warning));
  input.from_lonlat = features.in_degrees;
  input.projection = features.in_degrees ? project(features, projection, file) : features.projection;
  input.pslg = to_pslg(features);
  return input;
}

namespace {

/// GDAL, if it is there, knows the systems that are not known here: what is in Mercator's projection or in feet does
/// not go for meters.
InputFile read_geojson(const std::string& path, const std::string& projection) {
  GeoFeatures features = parse_geojson(path, read_file(path, kBeginsJson));
  if (!features.knows_system() && !is_standard_stream(path) && can_read_vectors()) {
    GeoFeatures known = parse_geojson(path, vector_as_geojson(path, ""));
    if (known.system == kInMeters)
      features.in_meters = true;  // and remain as they are
    else if (known.system != kWgs84 || may_be_wgs84(features.system))
      features = std::move(known);
  }
  return input_of(path, std::move(features), projection);
}

}  // namespace

InputFile parse_geojson_input(const std::string& file, std::string_view text, const std::string& projection) {
  return input_of(file, parse_geojson(file, text), projection);
}

InputFile read_geometry(const std::string& path, const std::string& layers, const std::string& projection) {
  if (is_vector_file(path)) return parse_geojson_input(path, vector_as_geojson(path, layers), projection);
  if (!layers.empty()) throw InputError({path}, "has no layers", "name layers of files that have some, such as .gpkg");
  if (is_geojson(path)) return read_geojson(path, projection);
  return {read_poly(path), {}, {}};
}

void project_degrees(InputFile& input, const std::string& projection, const std::string& file) {
  GeoFeatures places;
  places.points = input.pslg.points;
  for (const Point& p : places.points)
    if (std::abs(p.x) > 360 || std::abs(p.y) > 90)
      throw InputError({file}, "has coordinates that are no longitude and latitude", "they are not in degrees");
  unwrap_longitudes(places);
  const Projection plane = given_projection(projection, places.points, false, file);
  const auto project_all = [&](auto& items, const auto& place_of) {
    for (auto& item : items) place_of(item) = plane.plane(place_of(item));
  };
  project_all(input.pslg.points, [](Point& p) -> Point& { return p; });
  project_all(input.pslg.holes, [](Point& p) -> Point& { return p; });
  project_all(input.pslg.regions, [](Pslg::Region& region) -> Point& { return region.at; });
  input.projection = plane.name();
  input.from_lonlat = true;
}

std::vector<std::string> geometry_files(const std::string& path) {
  if (is_geojson(path)) return {path};
  if (is_vector_file(path)) return vector_files(path);
  return poly_files(path);
}

}  // namespace driftmesh
