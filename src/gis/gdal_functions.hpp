#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#ifdef DRIFTMESH_GDAL_LIBRARY
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <cpl_minixml.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#endif

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

// Each name is a member, its type, and what it is found by.
// clang-format off
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define DRIFTMESH_GDAL_FUNCTIONS(USE)                                                                              \
  USE(CPLCalloc) USE(CPLDestroyXMLNode) USE(CPLErrorReset) USE(CPLGetLastErrorMsg) USE(CPLGetLastErrorType) \
  USE(CPLParseXMLFile) USE(CPLStrdup)                                                                               \
  USE(CPLHTTPPopFetchCallback) USE(CPLHTTPPushFetchCallback) USE(CPLPopErrorHandler) USE(CPLPushErrorHandler)       \
  USE(CPLQuietErrorHandler) USE(CPLSetThreadLocalConfigOption) USE(GDALAllRegister) USE(GDALClose)                  \
  USE(GDALDatasetGetLayer) USE(GDALDatasetGetLayerByName) USE(GDALDatasetGetLayerCount) USE(GDALFlushCache)         \
  USE(GDALGetGeoTransform) USE(GDALGetMaskBand) USE(GDALGetMaskFlags) USE(GDALGetRasterBand) USE(GDALGetRasterColorInterpretation)                 \
  USE(GDALGetRasterCount) USE(GDALGetRasterNoDataValue)             \
  USE(GDALGetRasterOffset) USE(GDALGetRasterScale) USE(GDALGetRasterXSize) USE(GDALGetRasterYSize)                  \
  USE(GDALGetSpatialRef) USE(GDALOpenEx) USE(GDALRasterIO) USE(OCTDestroyCoordinateTransformation)                  \
  USE(OCTNewCoordinateTransformation) USE(OCTTransform) USE(OGR_F_Destroy) USE(OGR_F_GetFieldAsDouble)              \
  USE(OGR_F_GetFieldAsInteger64) USE(OGR_F_GetFieldAsString) USE(OGR_F_GetFieldCount) USE(OGR_F_GetFieldDefnRef)    \
  USE(OGR_F_GetGeometryRef) USE(OGR_F_IsFieldSetAndNotNull) USE(OGR_Fld_GetNameRef) USE(OGR_Fld_GetType)            \
  USE(OGR_GT_Flatten) USE(OGR_G_DestroyGeometry) USE(OGR_G_GetGeometryCount) USE(OGR_G_GetGeometryRef)              \
  USE(OGR_G_GetGeometryType) USE(OGR_G_GetLinearGeometry) USE(OGR_G_GetPointCount) USE(OGR_G_GetX) USE(OGR_G_GetY)  \
  USE(OGR_G_Transform) USE(OGR_L_GetName) USE(OGR_L_GetNextFeature) USE(OGR_L_GetSpatialRef)                        \
  USE(OGR_L_ResetReading) USE(OSRDestroySpatialReference) USE(OSRGetAttrValue) USE(OSRGetLinearUnits)               \
  USE(OSRGetPROJEnableNetwork) USE(OSRGetUTMZone) USE(OSRImportFromEPSG) USE(OSRImportFromProj4) USE(OSRIsGeographic)   \
  USE(OSRIsProjected)                                                                                               \
  USE(OSRIsSame) USE(OSRNewSpatialReference) USE(OSRSetAxisMappingStrategy) USE(OSRSetPROJEnableNetwork)
// clang-format on

/// The functions of GDAL that are used here. The library is loaded when they are first asked for.
struct GdalFunctions {
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage,bugprone-macro-parentheses): a name cannot be in parentheses here
#define DRIFTMESH_GDAL_MEMBER(name) decltype(&::name) name;
  DRIFTMESH_GDAL_FUNCTIONS(DRIFTMESH_GDAL_MEMBER)
#undef DRIFTMESH_GDAL_MEMBER

  /// Whether a coordinate system is one of places on the globe, and not of a drawing.
  [[nodiscard]] bool is_on_globe(OGRSpatialReferenceH system) const {
    return OSRIsGeographic(system) != 0 || OSRIsProjected(system) != 0;
  }
  /// Whether it is one of Mercator's whose meters are none (see Mercator), not a transverse or oblique one.
  [[nodiscard]] bool is_mercator(OGRSpatialReferenceH system) const {
    const char* const projection = OSRIsProjected(system) != 0 ? OSRGetAttrValue(system, "PROJECTION", 0) : nullptr;
    return projection != nullptr && std::string_view(projection).starts_with("Mercator");
  }
};

[[nodiscard]] bool is_gdal_there();

/// To read this file. Throws InputError that says how to get GDAL where it cannot be loaded.
[[nodiscard]] const GdalFunctions& gdal_for(const std::string& file);

/// To transform coordinates of this file, which need not exist yet. Throws likewise.
[[nodiscard]] const GdalFunctions& gdal_to_transform(const std::string& file);

/// An object of GDAL, and what destroys it.
template <class Handle>
using OwnedByUs = std::unique_ptr<std::remove_pointer_t<Handle>, std::function<void(Handle)>>;

/// Opens a file for reading, as GDAL_OF_VECTOR or GDAL_OF_RASTER, by the drivers for its extension alone: GDAL itself
/// goes by the content, and some formats are descriptions of other files, of servers and of databases. Throws FileError
/// where the file is not there or may not be read, and InputError for an extension without a driver, a file that is
/// something else than its extension says, one that is no regular file, and one that leads to others.
[[nodiscard]] OwnedByUs<GDALDatasetH> open_by_gdal(const GdalFunctions& gdal, const std::string& file, unsigned kind);

/// While it exists, no file leads GDAL into a network in this thread. (Requests of PROJ for grids are off in all.) To
/// be destroyed in the reverse order.
class OfflineGdal {
 public:
  explicit OfflineGdal(const GdalFunctions& gdal);
  ~OfflineGdal();
  OfflineGdal(const OfflineGdal&) = delete;
  OfflineGdal& operator=(const OfflineGdal&) = delete;

 private:
  const GdalFunctions& gdal_;
  int grids_from_network_;
};

/// While it exists, errors of GDAL are not printed in this thread, only kept for message().
class QuietGdal {
 public:
  explicit QuietGdal(const GdalFunctions& gdal);
  ~QuietGdal();
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
  /// The last error or warning; `otherwise` if there was none.
  [[nodiscard]] std::string message(const std::string& otherwise) const;
  /// Whether the last of them was an error.
  [[nodiscard]] bool failed() const;

 private:
  const GdalFunctions& gdal_;
};

#else

/// Throws InputError: this program was built without GDAL.
[[noreturn]] void refuse_without_gdal(const std::string& file);

#endif

}  // namespace driftmesh
