#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A zone of the Universal Transverse Mercator projection: six degrees wide, of one hemisphere.
struct UtmZone {
  int number = 31;    ///< from 1, which begins at 180 degrees west, to 60
  bool north = true;  ///< south of the equator, 10,000 km are added to northings

  [[nodiscard]] double central_meridian() const { return 6.0 * number - 183; }
  /// "UTM zone 18N"
  [[nodiscard]] std::string name() const;
  /// The code of the zone on WGS 84 in the EPSG's list of coordinate systems: 32618.
  [[nodiscard]] int epsg() const { return (north ? 32'600 : 32'700) + number; }
};

/// The zone of a name; none if it is not the name of a zone.
[[nodiscard]] std::optional<UtmZone> utm_zone_named(std::string_view name);
/// The zone of an EPSG code; none if it is another system's.
[[nodiscard]] std::optional<UtmZone> utm_zone_of_epsg(int code);

/// The zone of a place; degrees. Longitudes outside of -180 to 180 count around the globe.
[[nodiscard]] UtmZone utm_zone_of(double longitude, double latitude);

/// Easting and northing in meters on the ellipsoid WGS 84 (Krueger's series to the sixth order in the third flattening;
/// Karney, Transverse Mercator with an accuracy of a few nanometers, J. Geodesy 85, 2011). Accurate to a micrometer
/// within 40 degrees of the central meridian. Conformal: angles are those on the ellipsoid, and lengths are 0.9996
/// times as long on the central meridian, and the same 180 km away from it.
[[nodiscard]] Point utm(double longitude, double latitude, const UtmZone& zone);

/// The inverse: longitude and latitude of a place, in degrees, as accurate. The longitude is within 180 degrees of the
/// central meridian, which may lie beyond 180.
[[nodiscard]] Point geographic(const Point& place, const UtmZone& zone);

}  // namespace driftmesh
