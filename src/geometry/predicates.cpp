#include "geometry/predicates.hpp"

namespace driftmesh {

double orient2d_exact(const Point& a, const Point& b, const Point& c) {
  const long double l = (static_cast<long double>(a.x) - c.x) * (static_cast<long double>(b.y) - c.y);
  const long double r = (static_cast<long double>(a.y) - c.y) * (static_cast<long double>(b.x) - c.x);
  return static_cast<double>(l - r);
}

double incircle_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  using L = long double;
  const L ax = L(a.x) - d.x, ay = L(a.y) - d.y, bx = L(b.x) - d.x, by = L(b.y) - d.y, cx = L(c.x) - d.x, cy = L(c.y) - d.y;
  return static_cast<double>((ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) + (cx * cx + cy * cy) * (ax * by - ay * bx));
}

}  // namespace driftmesh
