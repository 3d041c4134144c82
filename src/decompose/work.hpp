#pragma once

#include <cstdint>
#include <vector>

#include "mesh/bounds.hpp"

namespace driftmesh {

/// Triangles per area bound in a finished mesh: what refinement makes of area / bound (measured at 20 degrees).
inline constexpr double kTrianglesPerBound = 1.55;

/// The largest area that a triangle in the region with this label may have; kNoBound if nothing is said. Without the
/// bounds' size field.
[[nodiscard]] double area_bound(const QualityBounds& bounds, std::uint16_t region);

/// The density of work, per area, in the region with this label. 1 everywhere if the bounds say nothing about size; a
/// region without a bound next to regions with one counts as a tenth of the least dense of them.
[[nodiscard]] double work_density(const QualityBounds& bounds, std::uint16_t region);

}  // namespace driftmesh
