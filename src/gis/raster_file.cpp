#include "gis/raster_file.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "driftmesh/error.hpp"
#include "gis/coordinates.hpp"
#include "gis/gdal_functions.hpp"

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

namespace {

/// Blocks of a file with tiles are needed for many rows, but GDAL would keep them all, up to a twentieth of the memory.
constexpr std::int64_t kRowsKept = 1024;

class GdalRaster final : public RasterRows {
 public:
  explicit GdalRaster(const std::string& file)
      : file_(file), gdal_(gdal_for(file)), offline_(gdal_), data_(open_by_gdal(gdal_, file, GDAL_OF_RASTER)) {
    if (gdal_.GDALGetRasterCount(data_.get()) == 0)
      fail("holds no raster by itself, but maybe several", "extract one with gdal_translate; gdalinfo lists them");
    set_frame();
  }

  [[nodiscard]] const RasterFrame& frame() const override { return frame_; }
  [[nodiscard]] PlaceFunction to_plane(const Projection& projection) const override {
    const OGRSpatialReferenceH own = gdal_.GDALGetSpatialRef(data_.get());
    if (own == nullptr || !gdal_.is_on_globe(own)) return RasterRows::to_plane(projection);
    const std::shared_ptr<Transformation> from_own = transformation(own, projection.definition(), Direction::kFromOwn);
    if (from_own == nullptr) return nullptr;
    return [this, from_own](const Point& p) { return transformed(from_own.get(), p); };
  }
  [[nodiscard]] PlaceFunction from_plane(const Projection& projection) const override {
    const OGRSpatialReferenceH own = gdal_.GDALGetSpatialRef(data_.get());
    if (own == nullptr || !gdal_.is_on_globe(own)) return RasterRows::from_plane(projection);
    const std::shared_ptr<Transformation> to_own = transformation(own, projection.definition(), Direction::kToOwn);
    if (to_own == nullptr) return nullptr;
    const bool in_degrees = gdal_.OSRIsGeographic(own) != 0;
    const double middle = frame_.first.x + frame_.dx * static_cast<double>(frame_.columns - 1) / 2;
    return [this, to_own, in_degrees, middle](const Point& p) {
      Point place = transformed(to_own.get(), p);
      if (in_degrees) place.x = middle + std::remainder(place.x - middle, 360);  // as the raster counts longitudes
      return place;
    };
  }

  [[nodiscard]] DomainSystem domain_system() const override {
    const OGRSpatialReferenceH own = gdal_.GDALGetSpatialRef(data_.get());
    if (own == nullptr || !gdal_.is_on_globe(own)) return RasterRows::domain_system();
    DomainSystem system{.in_degrees = true};
    std::string code = "EPSG:4326";  // WGS 84
    if (gdal_.OSRIsProjected(own) != 0 && gdal_.OSRGetLinearUnits(own, nullptr) == 1 && !gdal_.is_mercator(own)) {
      system.in_degrees = false;
      int north = 0;
      const int number = gdal_.OSRGetUTMZone(own, &north);
      if (number == 0) return system;
      const UtmZone zone{number, north != 0};
      system.projection = zone.name();
      code = Projection(zone).definition();
    }
    if (const auto from_own = transformation(own, code, Direction::kFromOwn))
      system.from_raster = [this, from_own](const Point& p) { return transformed(from_own.get(), p); };
    return system;
  }

  [[nodiscard]] bool in_mercator() const override {
    const OGRSpatialReferenceH own = gdal_.GDALGetSpatialRef(data_.get());
    return own != nullptr && gdal_.is_mercator(own);
  }

  void read(std::int64_t j, std::int64_t first, std::span<float> values) override {
    const QuietGdal quiet(gdal_);
    row_.resize(values.size());
    const auto top = static_cast<int>(upside_down_ ? j : frame_.rows - 1 - j);
    const int count = static_cast<int>(values.size());
    const auto read_row = [&](GDALRasterBandH band, void* into, GDALDataType type) {
      if (gdal_.GDALRasterIO(band, GF_Read, static_cast<int>(first), top, count, 1, into, count, 1, type, 0, 0) !=
          CE_None)
        fail("cannot be read at row " + std::to_string(top + 1) + ": " + quiet.message("no reason is known"),
             "it was not written completely, or is damaged");
    };
    read_row(band_, row_.data(), GDT_Float64);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = value_of(row_[k]);
    if (mask_ != nullptr) {
      seen_.resize(values.size());
      read_row(mask_, seen_.data(), GDT_Byte);
      for (std::size_t k = 0; k < values.size(); ++k)
        if (seen_[k] == 0) values[k] = std::numeric_limits<float>::quiet_NaN();
    }
    if (j % kRowsKept == 0) gdal_.GDALFlushCache(data_.get());
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& next) const {
    throw InputError({file_}, what, next);
  }

  using Transformation = std::remove_pointer_t<OGRCoordinateTransformationH>;
  enum class Direction { kToOwn, kFromOwn };

  /// Between the system of the file and one that PROJ knows; null if they are the same.
  [[nodiscard]] std::shared_ptr<Transformation> transformation(OGRSpatialReferenceH own, const std::string& definition,
                                                               Direction direction) const {
    const QuietGdal quiet(gdal_);
    const OwnedByUs<OGRSpatialReferenceH> system(
        gdal_.OSRNewSpatialReference(nullptr), [this](OGRSpatialReferenceH s) { gdal_.OSRDestroySpatialReference(s); });
    const auto code = epsg_from(definition);
    if ((code ? gdal_.OSRImportFromEPSG(system.get(), *code)
              : gdal_.OSRImportFromProj4(system.get(), definition.c_str())) != OGRERR_NONE)
      fail(quiet.message("PROJ does not know the projection of the domain"),
           "its data may be missing: install proj-data");
    gdal_.OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER);
    if (gdal_.OSRIsSame(own, system.get()) != 0) return nullptr;
    const bool to_own = direction == Direction::kToOwn;
    std::shared_ptr<Transformation> made(
        gdal_.OCTNewCoordinateTransformation(to_own ? system.get() : own, to_own ? own : system.get()),
        [&gdal = gdal_](OGRCoordinateTransformationH t) { gdal.OCTDestroyCoordinateTransformation(t); });
    if (made == nullptr) fail(quiet.message("lies in an unknown coordinate system"), "reproject it with gdalwarp");
    return made;
  }

  [[nodiscard]] Point transformed(OGRCoordinateTransformationH transformation, Point p) const {
    const QuietGdal quiet(gdal_);
    if (gdal_.OCTTransform(transformation, 1, &p.x, &p.y, nullptr) == 0)
      fail("cannot be placed in the domain's system", "reproject it with gdalwarp");
    return p;
  }

  void set_frame() {
    const GDALDatasetH data = data_.get();
    std::array<double, 6> place{};
    if (gdal_.GDALGetGeoTransform(data, place.data()) != CE_None)
      fail("does not say where its values are", "give it a place with gdal_translate -a_ullr");
    if (place[2] != 0 || place[4] != 0 || !(place[1] > 0) || place[5] == 0)
      fail("has rows that do not run from west to east", "make it upright with gdalwarp");
    upside_down_ = place[5] > 0;
    frame_.columns = gdal_.GDALGetRasterXSize(data);
    frame_.rows = gdal_.GDALGetRasterYSize(data);
    frame_.dx = place[1];
    frame_.dy = std::abs(place[5]);
    const double low = upside_down_ ? place[3] : place[3] + place[5] * static_cast<double>(frame_.rows);
    frame_.first = {place[0] + frame_.dx / 2, low + frame_.dy / 2};
    band_ = gdal_.GDALGetRasterBand(data, 1);
    int given = 0;
    const double none = gdal_.GDALGetRasterNoDataValue(band_, &given);
    if (given != 0) none_ = none;
    const double scale = gdal_.GDALGetRasterScale(band_, &given);
    if (given != 0) scale_ = scale;
    const double offset = gdal_.GDALGetRasterOffset(band_, &given);
    if (given != 0) offset_ = offset;
    mask_ = mask();
  }

  /// Null: there is none. GDAL takes a band of transparency for a mask only where values are integers.
  [[nodiscard]] GDALRasterBandH mask() const {
    if ((gdal_.GDALGetMaskFlags(band_) & (GMF_ALL_VALID | GMF_NODATA)) == 0) return gdal_.GDALGetMaskBand(band_);
    const int count = gdal_.GDALGetRasterCount(data_.get());
    const GDALRasterBandH last = gdal_.GDALGetRasterBand(data_.get(), count);
    return count > 1 && gdal_.GDALGetRasterColorInterpretation(last) == GCI_AlphaBand ? last : nullptr;
  }

  [[nodiscard]] float value_of(double stored) const {
    const auto value = static_cast<float>(stored * scale_ + offset_);
    return (none_ && stored == *none_) || !std::isfinite(value) ? std::numeric_limits<float>::quiet_NaN() : value;
  }

  std::string file_;
  const GdalFunctions& gdal_;
  OfflineGdal offline_;
  OwnedByUs<GDALDatasetH> data_;
  GDALRasterBandH band_ = nullptr;
  GDALRasterBandH mask_ = nullptr;  // null: nothing is hidden
  RasterFrame frame_;
  bool upside_down_ = false;
  std::optional<double> none_;
  double scale_ = 1, offset_ = 0;
  std::vector<double> row_;
  std::vector<std::uint8_t> seen_;  // 0 where the mask hides a value
};

}  // namespace

std::unique_ptr<RasterRows> open_raster_file(const std::string& path) {
  return std::make_unique<GdalRaster>(path);
}

#else

std::unique_ptr<RasterRows> open_raster_file(const std::string& path) {
  refuse_without_gdal(path);
}

#endif

}  // namespace driftmesh
