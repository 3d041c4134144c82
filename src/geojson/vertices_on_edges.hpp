#pragma once

#include <functional>

#include "geojson/geojson.hpp"

namespace driftmesh {

/// Takes all points of the features from one plane to another. Edges that were straight remain straight: each first
/// becomes several, with the vertices between them that lie on it. So a vertex of a polygon bends an edge that it lies
/// on. Other points are put onto the edge of a polygon that they lie on: what lines and points say of a domain never
/// changes its area.
void project_with_edges(GeoFeatures& features, const std::function<Point(const Point&)>& projection);

}  // namespace driftmesh
