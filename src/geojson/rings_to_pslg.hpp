#pragma once

#include <string>

#include "driftmesh/pslg.hpp"
#include "geojson/geojson.hpp"

namespace driftmesh {

/// Degrees to meters in a plane: that which `asked` names, or one that suits (choose_projection.hpp); returns its name.
/// Across the 180th meridian longitudes count on, and polygons that were cut there are joined (dateline.hpp); what goes
/// all around a pole is closed there (around_pole.hpp). What touches in degrees touches in meters
/// (vertices_on_edges.hpp), unless it goes around a pole. Throws InputError for `file` where coordinates are no
/// longitudes and latitudes, or reach too far for a plane.
std::string project(GeoFeatures& features, const std::string& asked, const std::string& file);

/// The domain: polygons, with lines and points as constraints. Lines come first: where segments coincide, theirs
/// counts. The markers of first rings without one are kGeoLand, of the others kGeoIsland. Equal points are one point,
/// and equal regions one region.
[[nodiscard]] Pslg to_pslg(const GeoFeatures& features);

}  // namespace driftmesh
