#pragma once

#include <string>

#include "driftmesh/pslg.hpp"
#include "geojson/geojson.hpp"

namespace driftmesh {

/// Degrees to meters in the UTM zone of the middle of everything; returns its name. Throws InputError for `file` where
/// coordinates are no longitudes and latitudes, lie beyond 84 degrees north or 80 south, or more than 40 degrees from
/// the middle, where the projection is no longer true to scale.
std::string project(GeoFeatures& features, const std::string& file);

/// The domain: polygons without their holes, with lines and points as constraints. Lines come first: where segments
/// coincide, theirs counts. The markers of outer rings without one are kGeoLand, of their holes kGeoIsland. Equal
/// points are one point. Throws InputError for a hole or a region without room for a point inside.
[[nodiscard]] Pslg to_pslg(const GeoFeatures& features, const std::string& file);

}  // namespace driftmesh
