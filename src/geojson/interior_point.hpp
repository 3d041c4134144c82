#pragma once

#include <optional>
#include <span>

#include "driftmesh/point.hpp"
#include "geometry/polygon.hpp"

namespace driftmesh {

/// A roomy point inside of the first ring that an odd number of all rings encloses: for a polygon, where its holes are
/// not. Nothing if there is none, or only in strips too thin for double precision.
[[nodiscard]] std::optional<Point> interior_point(std::span<const PolygonRing* const> rings);

}  // namespace driftmesh
