#include "gis/raster_rows.hpp"

#include <cmath>

namespace driftmesh {
namespace {

Point last_of(const RasterFrame& f) {
  return {f.first.x + f.dx * static_cast<double>(f.columns - 1), f.first.y + f.dy * static_cast<double>(f.rows - 1)};
}

bool could_be_degrees(const RasterFrame& f) {
  const Point low = f.first, high = last_of(f);
  return low.x >= -360 && high.x <= 360 && low.y >= -90 && high.y <= 90;
}

}  // namespace

DomainSystem RasterRows::domain_system() const {
  return {.in_degrees = could_be_degrees(frame())};
}

PlaceFunction RasterRows::to_plane(const Projection& projection) const {
  if (!could_be_degrees(frame())) return nullptr;
  return [=](const Point& p) { return projection.plane(p); };
}

PlaceFunction RasterRows::from_plane(const Projection& projection) const {
  if (!could_be_degrees(frame())) return nullptr;
  const Point low = frame().first, high = last_of(frame());
  // As the raster counts longitudes, some of which begin at Greenwich.
  const double middle = (low.x + high.x) / 2;
  return [=](const Point& p) {
    const Point found = projection.geographic(p);
    return Point{middle + std::remainder(found.x - middle, 360), found.y};
  };
}

}  // namespace driftmesh
