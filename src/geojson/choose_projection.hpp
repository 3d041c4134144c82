#pragma once

#include <span>
#include <string>

#include "driftmesh/point.hpp"
#include "gis/projection.hpp"

namespace driftmesh {

/// The plane for places in degrees, whose longitudes count on (see unwrap_longitudes): the UTM zone of their middle
/// where all are within 40 degrees of its meridian and between 80 degrees south and 84 north; otherwise a stereographic
/// projection around the middle of their longitudes and latitudes, or around a pole if all are nearer to that, or if
/// `around_pole`, since they are all around it. Throws InputError for `file` where places are more than 60 degrees from
/// the center, and so far from true to scale.
[[nodiscard]] Projection choose_projection(std::span<const Point> places, bool around_pole, const std::string& file);

/// The plane that a setting names, such as "UTM zone 18N" or "stereographic at 0 90"; "auto": as choose_projection.
/// Throws InputError where places are more than 60 degrees from its center, or 40 from its meridian.
[[nodiscard]] Projection given_projection(const std::string& asked, std::span<const Point> places, bool around_pole,
                                          const std::string& file);

}  // namespace driftmesh
