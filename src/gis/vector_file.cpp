#include "gis/vector_file.hpp"

#ifdef DRIFTMESH_GDAL_LIBRARY
#include <nlohmann/json.hpp>
#endif

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/key_error.hpp"
#include "base/letter_case.hpp"
#include "driftmesh/error.hpp"
#include "gis/gdal_functions.hpp"
#include "gis/transverse_mercator.hpp"

namespace driftmesh {

bool is_vector_file(const std::string& path) {
  static constexpr std::array<std::string_view, 6> kKnown{".shp", ".gpkg", ".fgb", ".gml", ".kml", ".gmt"};
  return std::ranges::find(kKnown, std::filesystem::path(path).extension().string()) != kKnown.end();
}

std::vector<std::string> vector_files(const std::string& path) {
  std::vector<std::string> files{path};
  if (!path.ends_with(".shp")) return files;
  for (const char* beside : {".shx", ".dbf", ".prj", ".cpg"})
    if (std::string other = std::filesystem::path(path).replace_extension(beside).string();
        std::filesystem::exists(other))
      files.push_back(std::move(other));
  return files;
}

#ifdef DRIFTMESH_GDAL_LIBRARY

namespace {

using Json = nlohmann::json;

class VectorReader {
 public:
  explicit VectorReader(const std::string& file)
      : file_(file),
        gdal_(gdal_for(file)),
        quiet_(gdal_),
        offline_(gdal_),
        data_(open_by_gdal(gdal_, file, GDAL_OF_VECTOR)) {}

  Json read(const std::string& names) {
    Json collection = {{"type", "FeatureCollection"}, {"features", Json::array()}};
    std::string first;
    for (const OGRLayerH layer : layers_of(names)) {
      const std::string system = use_system_of(layer);
      if (collection["features"].empty()) first = system;
      if (system != first)
        throw InputError({file_}, "has layers in different coordinate systems",
                         "name one of them, or reproject the others");
      read_features(layer, collection["features"]);
    }
    if (!first.empty()) collection["crs"] = {{"type", "name"}, {"properties", {{"name", first}}}};
    return collection;
  }

 private:
  std::vector<OGRLayerH> layers_of(const std::string& names) const {
    std::vector<OGRLayerH> layers;
    std::istringstream words(names);
    for (std::string name; std::getline(words, name, ',');) {
      layers.push_back(gdal_.GDALDatasetGetLayerByName(data_.get(), name.c_str()));
      if (layers.back() == nullptr)
        throw InputError({file_}, "has no layer '" + name + "'", "its layers are " + list_of_layers());
      if (std::ranges::count(layers, layers.back()) > 1)
        throw Keyed<InputError>({file_}, "layer '" + name + "' is named twice", "correct {input.layers}");
    }
    if (!layers.empty()) return layers;
    const int count = gdal_.GDALDatasetGetLayerCount(data_.get());
    if (count == 0) throw InputError({file_}, "has no layer", "there is nothing to mesh");
    if (count > 1)
      throw Keyed<InputError>({file_}, "has " + std::to_string(count) + " layers: " + list_of_layers(),
                              "say which to read: {input.layers} with names and commas between them");
    return {gdal_.GDALDatasetGetLayer(data_.get(), 0)};
  }

  std::string list_of_layers() const {
    std::string list;
    for (int k = 0; k < gdal_.GDALDatasetGetLayerCount(data_.get()); ++k)
      list += (k > 0 ? ", " : "") + std::string(gdal_.OGR_L_GetName(gdal_.GDALDatasetGetLayer(data_.get(), k)));
    return list;
  }

  /// Decides whether coordinates are transformed; returns the name of the system that they are in then, empty for
  /// what became degrees.
  std::string use_system_of(OGRLayerH layer) {
    transformation_ = nullptr;
    const OGRSpatialReferenceH system = gdal_.OGR_L_GetSpatialRef(layer);
    if (system == nullptr || !gdal_.is_on_globe(system)) return kUnsaid;
    if (gdal_.OSRIsProjected(system) != 0 && gdal_.OSRGetLinearUnits(system, nullptr) == 1 &&
        !gdal_.is_mercator(system)) {
      int north = 0;
      const int zone = gdal_.OSRGetUTMZone(system, &north);
      if (zone == 0) return kInMeters;
      const int code = UtmZone{zone, north != 0}.epsg();
      transform(system, code);  // from another datum: the zone's number says nothing about that
      return "EPSG:" + std::to_string(code);
    }
    constexpr int kWgs84Code = 4326;
    return transform(system, kWgs84Code) ? "" : kWgs84;
  }

  /// Coordinates become those of the system with this EPSG code. Whether they are in another one.
  bool transform(OGRSpatialReferenceH system, int code) {
    const OwnedByUs<OGRSpatialReferenceH> target(
        gdal_.OSRNewSpatialReference(nullptr), [this](OGRSpatialReferenceH s) { gdal_.OSRDestroySpatialReference(s); });
    gdal_.OSRImportFromEPSG(target.get(), code);
    gdal_.OSRSetAxisMappingStrategy(target.get(), OAMS_TRADITIONAL_GIS_ORDER);
    if (gdal_.OSRIsSame(system, target.get()) != 0) return false;
    transformation_ = OwnedByUs<OGRCoordinateTransformationH>(
        gdal_.OCTNewCoordinateTransformation(system, target.get()),
        [this](OGRCoordinateTransformationH t) { gdal_.OCTDestroyCoordinateTransformation(t); });
    if (transformation_ == nullptr)
      throw InputError({file_}, quiet_.message("has an unknown coordinate system"),
                       "reproject it with ogr2ogr -t_srs EPSG:" + std::to_string(code));
    return true;
  }

  void read_features(OGRLayerH layer, Json& features) const {
    gdal_.OGR_L_ResetReading(layer);
    const auto destroy = [this](OGRFeatureH f) { gdal_.OGR_F_Destroy(f); };
    gdal_.CPLErrorReset();
    for (;;) {
      const OwnedByUs<OGRFeatureH> feature(gdal_.OGR_L_GetNextFeature(layer), destroy);
      if (feature == nullptr) break;
      features.push_back({{"type", "Feature"},
                          {"properties", fields_of(feature.get())},
                          {"geometry", geometry_of(feature.get(), features.size() + 1)}});
    }
    if (quiet_.failed())
      throw InputError({file_},
                       "cannot be read after feature " + std::to_string(features.size()) + ": " + quiet_.message(""),
                       "it was not written completely, or is damaged");
  }

  Json fields_of(OGRFeatureH feature) const {
    Json fields = Json::object();
    for (int k = 0; k < gdal_.OGR_F_GetFieldCount(feature); ++k) {
      if (gdal_.OGR_F_IsFieldSetAndNotNull(feature, k) == 0) continue;
      const OGRFieldDefnH field = gdal_.OGR_F_GetFieldDefnRef(feature, k);
      const std::string name = lower_case(gdal_.OGR_Fld_GetNameRef(field));
      switch (gdal_.OGR_Fld_GetType(field)) {
        case OFTInteger:
        case OFTInteger64:
          fields[name] = gdal_.OGR_F_GetFieldAsInteger64(feature, k);
          break;
        case OFTReal:
          fields[name] = gdal_.OGR_F_GetFieldAsDouble(feature, k);
          break;
        case OFTString:
          if (const std::string text = gdal_.OGR_F_GetFieldAsString(feature, k); !text.empty()) fields[name] = text;
          break;
        default:
          break;
      }
    }
    return fields;
  }

  Json geometry_of(OGRFeatureH feature, std::size_t number) const {
    const OGRGeometryH own = gdal_.OGR_F_GetGeometryRef(feature);
    if (own == nullptr) return nullptr;
    const OwnedByUs<OGRGeometryH> geometry(gdal_.OGR_G_GetLinearGeometry(own, 0, nullptr),
                                           [this](OGRGeometryH g) { gdal_.OGR_G_DestroyGeometry(g); });
    if (transformation_ != nullptr && gdal_.OGR_G_Transform(geometry.get(), transformation_.get()) != OGRERR_NONE)
      throw InputError({file_},
                       "feature " + std::to_string(number) + " has coordinates outside of its coordinate system",
                       "correct them, or reproject the file with ogr2ogr");
    return geometry_json(geometry.get(), number);
  }

  Json geometry_json(OGRGeometryH geometry, std::size_t number) const {
    const auto named = [&](const char* type, Json coordinates) {
      return Json{{"type", type}, {"coordinates", std::move(coordinates)}};
    };
    switch (gdal_.OGR_GT_Flatten(gdal_.OGR_G_GetGeometryType(geometry))) {
      case wkbPoint:
        return named("Point", gdal_.OGR_G_GetPointCount(geometry) == 0 ? Json::array() : position(geometry, 0));
      case wkbLineString:
        return named("LineString", positions(geometry));
      case wkbPolygon:
      case wkbTriangle:
        return named("Polygon", parts(geometry, [&](OGRGeometryH ring) { return positions(ring); }));
      case wkbMultiPoint:
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        return {{"type", "GeometryCollection"},
                {"geometries", parts(geometry, [&](OGRGeometryH part) { return geometry_json(part, number); })}};
      default:
        throw InputError({file_},
                         "feature " + std::to_string(number) + " has a geometry that is no point, line or polygon",
                         "convert it with ogr2ogr -nlt MULTIPOLYGON");
    }
  }

  template <class Convert>
  Json parts(OGRGeometryH geometry, const Convert& convert) const {
    Json all = Json::array();
    for (int k = 0; k < gdal_.OGR_G_GetGeometryCount(geometry); ++k)
      all.push_back(convert(gdal_.OGR_G_GetGeometryRef(geometry, k)));
    return all;
  }

  Json positions(OGRGeometryH line) const {
    Json all = Json::array();
    for (int k = 0; k < gdal_.OGR_G_GetPointCount(line); ++k) all.push_back(position(line, k));
    return all;
  }

  Json position(OGRGeometryH line, int k) const {
    return Json::array({gdal_.OGR_G_GetX(line, k), gdal_.OGR_G_GetY(line, k)});
  }

  const std::string& file_;
  const GdalFunctions& gdal_;
  QuietGdal quiet_;
  OfflineGdal offline_;
  OwnedByUs<GDALDatasetH> data_;
  OwnedByUs<OGRCoordinateTransformationH> transformation_;  // null: coordinates remain
};

}  // namespace

std::string vector_as_geojson(const std::string& path, const std::string& layers) {
  return VectorReader(path).read(layers).dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool can_read_vectors() {
  return is_gdal_there();
}

#else

bool can_read_vectors() {
  return false;
}

std::string vector_as_geojson(const std::string& path, const std::string& /*layers*/) {
  refuse_without_gdal(path);
}

#endif

}  // namespace driftmesh
