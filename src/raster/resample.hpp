#pragma once

#include <functional>

#include "geometry/box.hpp"
#include "raster/raster.hpp"

namespace driftmesh {

/// From places in one coordinate system to those in another.
using PlaceMap = std::function<Point(const Point&)>;

/// The values of a raster at the points of a grid over a box in other coordinates. Its spacing is a power of two, at
/// most those of the raster there, and its points are multiples of it, so that they hardly depend on the box.
/// `to_source`: smooth, from these coordinates to those of the raster. It is asked at every sixteenth point in each
/// direction, and is linear in between, which for map projections changes places by less than a hundredth of the
/// spacing for spacings up to ten kilometers. `jumps`: it is not smooth, since the box is around a pole of the raster's
/// longitudes and latitudes; then it is asked at every point, and the spacing is that of the raster's rows.
[[nodiscard]] TiledGrid resample(const GridRaster& source, const PlaceMap& to_source, const Box& box,
                                 bool jumps = false);

/// Calls visit(point) for 65 points on each side of a box.
template <class Visit>
void for_each_on_rim(const Box& box, const Visit& visit) {
  constexpr int kParts = 64;
  for (int k = 0; k <= kParts; ++k) {
    const double t = static_cast<double>(k) / kParts;
    const double x = box.low.x + (box.high.x - box.low.x) * t, y = box.low.y + (box.high.y - box.low.y) * t;
    for (const Point& p : {Point{x, box.low.y}, {x, box.high.y}, {box.low.x, y}, {box.high.x, y}}) visit(p);
  }
}

/// Around the image of a box, as far as points along its rim tell, and a hundredth of its size more.
[[nodiscard]] Box image_of(const Box& box, const PlaceMap& map);

}  // namespace driftmesh
