#include "geometry/polygon.hpp"

#include "geometry/predicates.hpp"

namespace driftmesh {

bool is_inside(std::span<const PolygonRing* const> rings, const Point& p) {
  bool inside = false;
  for_each_edge(rings, [&](const Point& a, const Point& b) {
    if (spans_height(a, b, p.y) && (orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
  });
  return inside;
}

}  // namespace driftmesh
