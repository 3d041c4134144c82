#pragma once

#include "geojson/geojson.hpp"

namespace driftmesh {

/// From -180, to 180 exclusive, rounded to 1e-10 degrees (a hundredth of a millimeter), so that a longitude is one
/// number however a file counts.
[[nodiscard]] double canonical_longitude(double longitude);

/// Counts longitudes on where they go once around the globe, so that all lie in one interval: where everything crosses
/// the 180th meridian those in the west of it become greater than 180. The interval leaves out the largest gap between
/// longitudes. Where nothing changes, all remain to the bit; otherwise all are rounded as canonical_longitude does.
void unwrap_longitudes(GeoFeatures& features);

/// Joins the polygons that were cut along the 180th meridian, as RFC 7946 asks for: where borders of two polygons
/// coincide there, with the same marker and region, they are left out, and what is left becomes rings again. Longitudes
/// must be unwrapped.
void join_at_dateline(GeoFeatures& features);

}  // namespace driftmesh
