#include "gis/coordinates.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "driftmesh/error.hpp"
#include "gis/gdal_functions.hpp"
#include "gis/projection.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kFrom = " from ", kEpsg = "EPSG:";
constexpr int kLonLatCode = 4326;

Projection known_projection(const std::string& name, const std::string& file) {
  if (const auto projection = projection_named(name)) return *projection;
  throw InputError({file}, "is in a projection '" + name + "', which is not known",
                   "a newer version of the program may know it");
}

#ifdef DRIFTMESH_GDAL_LIBRARY

/// Between longitudes and latitudes and a system of the EPSG.
class Reprojection {
 public:
  Reprojection(const std::string& file, int code) : file_(file), gdal_(gdal_to_transform(file)), offline_(gdal_) {
    const QuietGdal quiet(gdal_);
    const auto system = [&](int number) {
      OwnedByUs<OGRSpatialReferenceH> made(gdal_.OSRNewSpatialReference(nullptr),
                                           [this](OGRSpatialReferenceH s) { gdal_.OSRDestroySpatialReference(s); });
      if (gdal_.OSRImportFromEPSG(made.get(), number) != OGRERR_NONE)
        throw InputError({file_},
                         "cannot be in EPSG:" + std::to_string(number) + ": " + quiet.message("it is not known"),
                         "give the code of a system that PROJ knows");
      gdal_.OSRSetAxisMappingStrategy(made.get(), OAMS_TRADITIONAL_GIS_ORDER);
      return made;
    };
    const auto degrees = system(kLonLatCode), other = system(code);
    const auto way = [&](OGRSpatialReferenceH from, OGRSpatialReferenceH to) {
      OwnedByUs<OGRCoordinateTransformationH> made(
          gdal_.OCTNewCoordinateTransformation(from, to),
          [this](OGRCoordinateTransformationH t) { gdal_.OCTDestroyCoordinateTransformation(t); });
      if (made == nullptr)
        throw InputError({file_},
                         "cannot be in EPSG:" + std::to_string(code) + ": " + quiet.message("no way leads there"),
                         "give the code of another system");
      return made;
    };
    to_system_ = way(degrees.get(), other.get());
    to_degrees_ = way(other.get(), degrees.get());
  }

  [[nodiscard]] Point system(const Point& place) const { return transformed(to_system_.get(), place); }

  /// The inverse of system(), but for rounding. PROJ's own is up to a millimeter off where a series gives it, as in
  /// equal-area systems; its error there and back again is what its error once is.
  [[nodiscard]] Point degrees(const Point& place) const {
    const Point first = transformed(to_degrees_.get(), place);
    const Point again = transformed(to_degrees_.get(), system(first));
    return {first.x - std::remainder(again.x - first.x, 360.0), first.y - (again.y - first.y)};
  }

 private:
  [[nodiscard]] Point transformed(OGRCoordinateTransformationH way, Point p) const {
    const QuietGdal quiet(gdal_);
    if (gdal_.OCTTransform(way, 1, &p.x, &p.y, nullptr) == 0)
      throw InputError({file_}, "has places that its coordinate system has not: " + quiet.message("no reason is known"),
                       "give the code of a system around the domain");
    return p;
  }

  std::string file_;
  const GdalFunctions& gdal_;
  OfflineGdal offline_;
  OwnedByUs<OGRCoordinateTransformationH> to_system_, to_degrees_;
};

#else

/// Says that GDAL is missing.
class Reprojection {
 public:
  Reprojection(const std::string& file, int /*code*/) {
    throw InputError({file}, "takes GDAL for its coordinates, which this driftmesh was built without",
                     "install Debian's package libgdal-dev and build again, or use lonlat");
  }
  [[nodiscard]] Point system(const Point& place) const { return place; }
  [[nodiscard]] Point degrees(const Point& place) const { return place; }
};

#endif

/// The code of other coordinates than the plane's; kLonLatCode for degrees, none for those of the plane itself.
std::optional<int> code_of(const Projection& plane, const std::string& coordinates, const std::string& file) {
  if (coordinates == kLonLat) return kLonLatCode;
  const auto code = epsg_from(coordinates);
  if (!code)
    throw InputError({file}, "cannot be in the coordinates '" + coordinates + "'",
                     "give lonlat or a code, such as EPSG:3035");
  return coordinates == plane.definition() ? std::nullopt : code;
}

}  // namespace

std::string Coordinates::text() const {
  std::string text = in.empty() ? projection : in + std::string(kFrom) + projection;
  if (from_lonlat && in != kLonLat) text += std::string(kFrom) + kLonLat;
  return text;
}

std::optional<Coordinates> coordinates_from(std::string_view text) {
  Coordinates found;
  if (const std::size_t from = text.find(kFrom); from != std::string_view::npos) {
    const std::string_view before = text.substr(0, from);
    if (before == kLonLat || epsg_from(before)) {
      found.in = before;
      found.from_lonlat = before == kLonLat;
      text.remove_prefix(from + kFrom.size());
    }
  }
  if (const std::string end = std::string(kFrom) + kLonLat; text.ends_with(end)) {
    found.from_lonlat = true;
    text.remove_suffix(end.size());
  }
  if (!projection_named(text)) return std::nullopt;
  found.projection = text;
  return found;
}

std::optional<int> epsg_from(std::string_view text) {
  if (!text.starts_with(kEpsg)) return std::nullopt;
  text.remove_prefix(kEpsg.size());
  int code = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), code);
  return error == std::errc() && end == text.data() + text.size() && code > 0 ? std::optional(code) : std::nullopt;
}

std::function<Point(const Point&)> from_plane(const std::string& projection, const std::string& to,
                                              const std::string& file) {
  const Projection plane = known_projection(projection, file);
  const auto code = code_of(plane, to, file);
  if (!code) return [](const Point& p) { return p; };
  if (*code == kLonLatCode) return [plane](const Point& p) { return plane.geographic(p); };
  return [plane, other = std::make_shared<const Reprojection>(file, *code)](const Point& p) {
    return other->system(plane.geographic(p));
  };
}

std::function<Point(const Point&)> to_plane(const std::string& projection, const std::string& from,
                                            const std::string& file) {
  const Projection plane = known_projection(projection, file);
  const auto code = code_of(plane, from, file);
  if (!code) return [](const Point& p) { return p; };
  if (*code == kLonLatCode) return [plane](const Point& p) { return plane.plane(p); };
  return [plane, other = std::make_shared<const Reprojection>(file, *code)](const Point& p) {
    return plane.plane(other->degrees(p));
  };
}

}  // namespace driftmesh
