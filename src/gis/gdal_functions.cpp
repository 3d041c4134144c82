#include "gis/gdal_functions.hpp"

#ifdef DRIFTMESH_GDAL_LIBRARY
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <array>
#include <filesystem>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/letter_case.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "gis/mosaic_file.hpp"
#include "hdf5/own_content.hpp"

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

namespace {

struct Loaded {
  GdalFunctions functions{};
  std::string problem;  // empty: there is none
};

/// Is never closed: GDAL does not expect to be.
Loaded load() {
  Loaded loaded;
  void* const library = ::dlopen(DRIFTMESH_GDAL_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  const auto find = [&](auto& function, const char* name) {
    void* const found = library != nullptr && loaded.problem.empty() ? ::dlsym(library, name) : nullptr;
    if (found == nullptr && loaded.problem.empty()) loaded.problem = ::dlerror();  // NOLINT(concurrency-mt-unsafe)
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
  };
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define DRIFTMESH_GDAL_FIND(name) find(loaded.functions.name, #name);
  DRIFTMESH_GDAL_FUNCTIONS(DRIFTMESH_GDAL_FIND)
#undef DRIFTMESH_GDAL_FIND
  if (loaded.problem.empty()) loaded.functions.GDALAllRegister();
  return loaded;
}

const Loaded& loaded_once() {
  static const Loaded loaded = load();
  return loaded;
}

struct DriversOfExtension {
  const char* extension;
  std::vector<const char*> drivers;  // the end is marked for GDAL
};

/// Formats that hold their data themselves.
const std::vector<DriversOfExtension>& drivers_of(unsigned kind) {
  static const std::vector<DriversOfExtension> kVectors{
      {".shp", {"ESRI Shapefile", nullptr}}, {".gpkg", {"GPKG", nullptr}},
      {".fgb", {"FlatGeobuf", nullptr}},     {".gml", {"GML", nullptr}},
      {".kml", {"LIBKML", "KML", nullptr}},  {".gmt", {"OGR_GMT", nullptr}},
      {".geojson", {"GeoJSON", nullptr}},    {".json", {"GeoJSON", nullptr}}};
  static const std::vector<DriversOfExtension> kRasters{
      {".tif", {"GTiff", nullptr}},   {".tiff", {"GTiff", nullptr}},
      {".nc", {"netCDF", nullptr}},   {".nc4", {"netCDF", nullptr}},
      {".cdf", {"netCDF", nullptr}},  {".grd", {"netCDF", "GSBG", "GS7BG", "GSAG", nullptr}},
      {".dem", {"USGSDEM", nullptr}}, {".hgt", {"SRTMHGT", nullptr}},
      {".dt0", {"DTED", nullptr}},    {".dt1", {"DTED", nullptr}},
      {".dt2", {"DTED", nullptr}},    {".bil", {"EHdr", nullptr}},
      {".flt", {"EHdr", nullptr}},    {".xyz", {"XYZ", nullptr}},
      {".grb", {"GRIB", nullptr}},    {".grb2", {"GRIB", nullptr}},
      {".bag", {"BAG", nullptr}},     {".vrt", {"VRT", nullptr}}};
  return kind == GDAL_OF_VECTOR ? kVectors : kRasters;
}

std::vector<const char*> drivers_for(const std::string& file, unsigned kind) {
  const std::string extension = lower_case(std::filesystem::path(file).extension().string());
  std::string known;
  for (const DriversOfExtension& of : drivers_of(kind)) {
    if (of.extension == extension) return of.drivers;
    known += (known.empty() ? "" : ", ") + std::string(of.extension);
  }
  throw InputError({file}, extension.empty() ? "has no extension" : "has an unknown extension '" + extension + "'",
                   "GDAL is asked for " + known + "; gdal_translate makes a .tif of other rasters");
}

constexpr std::array<std::pair<const char*, const char*>, 5> kOffline{{
    {"CPL_VSIL_CURL_ALLOWED_FILENAME", "none"},
    {"GDAL_VRT_ENABLE_PYTHON", "NO"},
    {"GML_SKIP_RESOLVE_ELEMS", "ALL"},
    {"LIBKML_RESOLVE_STYLE", "NO"},
    {"OGR_SQLITE_STATIC_VIRTUAL_OGR", "NO"},
}};

/// Answers every request of GDAL with an error, in memory that GDAL frees.
CPLHTTPResult* refuse_request(const char* /*address*/, CSLConstList /*options*/, GDALProgressFunc /*progress*/,
                              void* /*of_progress*/, CPLHTTPFetchWriteFunc /*write*/, void* /*of_write*/, void* gdal) {
  const auto& functions = *static_cast<const GdalFunctions*>(gdal);
  auto* const result = static_cast<CPLHTTPResult*>(functions.CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = functions.CPLStrdup("files are read without a network");
  return result;
}

}  // namespace

bool is_gdal_there() {
  return loaded_once().problem.empty();
}

const GdalFunctions& gdal_for(const std::string& file) {
  require_regular_file(file);
  const Loaded& loaded = loaded_once();
  if (!loaded.problem.empty())
    throw InputError({file}, "takes GDAL to be read, which cannot be loaded (" + loaded.problem + ")",
                     "install Debian's package libgdal32, or convert the file to GeoJSON or .asc");
  return loaded.functions;
}

const GdalFunctions& gdal_to_transform(const std::string& file) {
  const Loaded& loaded = loaded_once();
  if (!loaded.problem.empty())
    throw InputError({file}, "takes GDAL for its coordinates, which cannot be loaded (" + loaded.problem + ")",
                     "install Debian's package libgdal32, or use lonlat");
  return loaded.functions;
}

OwnedByUs<GDALDatasetH> open_by_gdal(const GdalFunctions& gdal, const std::string& file, unsigned kind) {
  const std::vector<const char*> drivers = drivers_for(file, kind);
  if (kind == GDAL_OF_RASTER) require_own_content(file);
  if (is_mosaic_file(file)) require_plain_mosaic(gdal, file);
  constexpr std::array<const char*, 3> kOptions{"DOWNLOAD_SCHEMA=NO", "WRITE_GFS=NO", nullptr};  // only for GML
  const QuietGdal quiet(gdal);
  const bool is_gml = drivers.front() == std::string_view("GML");
  OwnedByUs<GDALDatasetH> data(gdal.GDALOpenEx(file.c_str(), kind | GDAL_OF_READONLY, drivers.data(),
                                               is_gml ? kOptions.data() : nullptr, nullptr),
                               [&gdal](GDALDatasetH opened) { gdal.GDALClose(opened); });
  if (data == nullptr)
    throw InputError({file}, quiet.message("is not what its extension says"),
                     "ogrinfo and gdalinfo say what GDAL makes of it");
  return data;
}

OfflineGdal::OfflineGdal(const GdalFunctions& gdal) : gdal_(gdal), grids_from_network_(gdal.OSRGetPROJEnableNetwork()) {
  for (const auto& [option, value] : kOffline) gdal_.CPLSetThreadLocalConfigOption(option, value);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): it is only read
  gdal_.CPLHTTPPushFetchCallback(refuse_request, const_cast<GdalFunctions*>(&gdal_));
  gdal_.OSRSetPROJEnableNetwork(0);
}

OfflineGdal::~OfflineGdal() {
  gdal_.OSRSetPROJEnableNetwork(grids_from_network_);
  gdal_.CPLHTTPPopFetchCallback();
  for (const auto& [option, value] : kOffline) gdal_.CPLSetThreadLocalConfigOption(option, nullptr);
}

QuietGdal::QuietGdal(const GdalFunctions& gdal) : gdal_(gdal) {
  gdal_.CPLPushErrorHandler(gdal_.CPLQuietErrorHandler);
  gdal_.CPLErrorReset();
}

QuietGdal::~QuietGdal() {
  gdal_.CPLPopErrorHandler();
}

std::string QuietGdal::message(const std::string& otherwise) const {
  const std::string found = gdal_.CPLGetLastErrorMsg();
  return found.empty() ? otherwise : found;
}

bool QuietGdal::failed() const {
  return gdal_.CPLGetLastErrorType() >= CE_Failure;
}

#else

void refuse_without_gdal(const std::string& file) {
  require_regular_file(file);
  throw InputError({file}, "takes GDAL to be read, which this driftmesh was built without",
                   "install Debian's package libgdal-dev and build again, or convert the file to GeoJSON or .asc");
}

#endif

}  // namespace driftmesh
