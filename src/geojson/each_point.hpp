#pragma once

#include <algorithm>

#include "geojson/geojson.hpp"

namespace driftmesh {

/// Calls visit(point) for each point of all geometries; it may change them.
template <class Visit>
void for_each_point(GeoFeatures& features, const Visit& visit) {
  for (GeoFeatures::Polygon& polygon : features.polygons)
    for (PolygonRing& ring : polygon.rings) std::ranges::for_each(ring, visit);
  for (GeoFeatures::Line& line : features.lines) std::ranges::for_each(line.points, visit);
  std::ranges::for_each(features.points, visit);
}

}  // namespace driftmesh
