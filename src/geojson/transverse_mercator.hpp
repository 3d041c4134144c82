#pragma once

#include <string>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A zone of the Universal Transverse Mercator projection: six degrees wide, of one hemisphere.
struct UtmZone {
  int number = 31;    ///< from 1, which begins at 180 degrees west, to 60
  bool north = true;  ///< south of the equator, 10,000 km are added to northings

  [[nodiscard]] double central_meridian() const { return 6.0 * number - 183; }
  /// "UTM zone 18N"
  [[nodiscard]] std::string name() const;
};

/// The zone of a place; degrees. Longitudes outside of -180 to 180 count around the globe.
[[nodiscard]] UtmZone utm_zone_of(double longitude, double latitude);

/// Easting and northing in meters on the ellipsoid WGS 84 (Krueger's series to the sixth order in the third flattening;
/// Karney, Transverse Mercator with an accuracy of a few nanometers, J. Geodesy 85, 2011). Accurate to a micrometer
/// within 40 degrees of the central meridian. Conformal: angles are those on the ellipsoid, and lengths are 0.9996
/// times as long on the central meridian, and the same 180 km away from it.
[[nodiscard]] Point utm(double longitude, double latitude, const UtmZone& zone);

}  // namespace driftmesh
