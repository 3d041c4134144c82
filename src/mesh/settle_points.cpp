#include "mesh/settle_points.hpp"

#include <algorithm>
#include <cmath>

namespace driftmesh {

void settle_points(std::vector<Point>& points, std::span<const Point> places, double distance) {
  std::vector<Point> sorted(places.begin(), places.end());
  std::ranges::sort(sorted, {}, &Point::x);
  for (Point& p : points)
    for (auto near = std::ranges::lower_bound(sorted, p.x - distance, {}, &Point::x);
         near != sorted.end() && near->x <= p.x + distance; ++near)
      if (std::abs(near->y - p.y) <= distance) {
        p = *near;
        break;
      }
}

}  // namespace driftmesh
