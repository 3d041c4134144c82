#include "gis/raster_rows.hpp"

#include <cmath>

namespace driftmesh {

std::function<Point(const Point&)> RasterRows::from_zone(const UtmZone& zone) const {
  const RasterFrame& f = frame();
  const Point low = f.first,
              high{low.x + f.dx * static_cast<double>(f.columns - 1), low.y + f.dy * static_cast<double>(f.rows - 1)};
  const bool degrees = low.x >= -360 && high.x <= 360 && low.y >= -90 && high.y <= 90;
  if (!degrees) return nullptr;
  // As the raster counts longitudes, some of which begin at Greenwich.
  const double middle = (low.x + high.x) / 2;
  return [=](const Point& p) {
    const Point found = geographic(p, zone);
    return Point{middle + std::remainder(found.x - middle, 360), found.y};
  };
}

}  // namespace driftmesh
