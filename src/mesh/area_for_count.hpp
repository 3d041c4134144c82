#pragma once

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The bound on area with which refinement to `bounds`, whose own bound on area does not count, is forecast to make
/// about `count` > 0 triangles. It is `count`'s share of the domain where the forecast agrees with that, as it does if
/// little but the bound on area asks for triangles; otherwise it is found by the forecast, up to half a percent.
/// Where angles, sizes and regions ask for more than `count` by themselves, it is the area of the domain.
[[nodiscard]] double area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count);

}  // namespace driftmesh
