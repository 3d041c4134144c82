#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Longitudes and latitudes on WGS 84, in Coordinates::in.
inline constexpr const char* kLonLat = "lonlat";

/// Meters by which points of a plane may be beside their places after they were in other coordinates. Longitudes up to
/// 180 degrees are rounded to 1.6e-9 m; the way through another system has some more such roundings.
inline constexpr double kRoundedPlaces = 3e-8;

/// What Mesh::coordinates says.
struct Coordinates {
  std::string projection;    ///< the plane in which the mesh was made
  std::string in{};          ///< what points are in, if that is not the plane: kLonLat or "EPSG:3035"
  bool from_lonlat = false;  ///< the domain was given in longitudes and latitudes

  /// "UTM zone 18N", "UTM zone 18N from lonlat", "lonlat from UTM zone 18N", "EPSG:3035 from UTM zone 18N from lonlat"
  [[nodiscard]] std::string text() const;
};

/// None: the text says nothing that is known here.
[[nodiscard]] std::optional<Coordinates> coordinates_from(std::string_view text);

/// The number in "EPSG:3035"; none if it is something else.
[[nodiscard]] std::optional<int> epsg_from(std::string_view text);

/// From the plane of a projection to other coordinates, kLonLat or "EPSG:3035", and back. For a code that is neither
/// that of the plane nor 4326, GDAL is needed. `file` is for messages. Throws InputError: for another text, for an
/// unknown code and without GDAL; the functions, for places that the system does not have.
[[nodiscard]] std::function<Point(const Point&)> from_plane(const std::string& projection, const std::string& to,
                                                            const std::string& file);
[[nodiscard]] std::function<Point(const Point&)> to_plane(const std::string& projection, const std::string& from,
                                                          const std::string& file);

}  // namespace driftmesh
