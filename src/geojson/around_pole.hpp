#pragma once

#include "geojson/geojson.hpp"

namespace driftmesh {

/// Whether something goes once around the globe: an edge of 360 degrees of longitude, as the side of a frame from -180
/// to 180, or a ring around a pole.
[[nodiscard]] bool goes_around(const GeoFeatures& features);

/// Puts points on edges, straight in degrees, so that none spans more than 4 degrees of longitude: in a plane that is
/// not that of degrees, each is then within a hundredth of its length where it should be. An edge between longitudes
/// that differ by more than 180 degrees, and less than 360, goes the short way.
void divide_long_edges(GeoFeatures& features);

/// Makes each place one pair of numbers, from -180 on, and each pole one point. Removes from rings what they then walk
/// to and fro along the 180th meridian: the way from a coast to the pole, or to another coast, which makes two rings of
/// one.
void close_at_dateline(GeoFeatures& features);

}  // namespace driftmesh
