#pragma once

#include <optional>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Mercator's projection of the whole globe, as web maps have it. Its unit is called meter, but is one only at the
/// equator: at 37 degrees north, areas are 58 % too large.
enum class Mercator {
  kWeb,    ///< projects the sphere
  kWorld,  ///< projects the ellipsoid WGS 84
};

/// By its code in the EPSG's list, or one of those that programs gave it before it had a place there; none for another
/// system.
[[nodiscard]] std::optional<Mercator> mercator_of_code(int code);

/// Longitude and latitude on WGS 84 of a place in the projection, in degrees. The longitude is beyond 180 where the
/// place is beyond the map.
[[nodiscard]] Point geographic(const Point& place, Mercator projection);

}  // namespace driftmesh
