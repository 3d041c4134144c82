#pragma once

#include <string>

#include "driftmesh/pslg.hpp"
#include "geojson/geojson.hpp"

namespace driftmesh {

/// Degrees to meters in the UTM zone of the middle of everything; returns its name. Across the 180th meridian
/// longitudes count on, and polygons that were cut there are joined (dateline.hpp). What touches in degrees touches in
/// meters (vertices_on_edges.hpp). Throws InputError for `file` where coordinates are no longitudes and latitudes, lie
/// beyond 84 degrees north or 80 south, or more than 40 degrees from the middle, where the projection is no longer true
/// to scale.
std::string project(GeoFeatures& features, const std::string& file);

/// The domain: polygons, with lines and points as constraints. Lines come first: where segments coincide, theirs
/// counts. The markers of first rings without one are kGeoLand, of the others kGeoIsland. Equal points are one point,
/// and equal regions one region.
[[nodiscard]] Pslg to_pslg(const GeoFeatures& features);

}  // namespace driftmesh
