#pragma once

#include "geometry/triangle_geometry.hpp"
#include "raster/raster.hpp"

namespace driftmesh {

/// The greatest value of a raster anywhere in a triangle, up to rounding: exact for one grid, whose values are bilinear
/// between its points. Where rasters of a stack blend into each other, it is the greatest at the same kind of places:
/// corners, points of the grids, and along edges. Does not depend on the order of the corners. Takes time in proportion
/// to the grid points in the triangle.
[[nodiscard]] double greatest_in(const Raster& raster, const CornerPoints& triangle);

}  // namespace driftmesh
