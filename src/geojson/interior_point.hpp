#pragma once

#include <optional>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The corners of a polygon in order, without the first one again at the end.
using PolygonRing = std::vector<Point>;

/// Whether an odd number of the rings encloses `p`. Exact, except on the rings themselves.
[[nodiscard]] bool is_inside(std::span<const PolygonRing* const> rings, Point p);

/// A roomy point inside of the first ring that an odd number of all rings encloses: for a polygon, where its holes are
/// not. Nothing if there is none, or only in strips too thin for double precision.
[[nodiscard]] std::optional<Point> interior_point(std::span<const PolygonRing* const> rings);

}  // namespace driftmesh
