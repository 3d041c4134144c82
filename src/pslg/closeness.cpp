#include "pslg/closeness.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

// 113 bits hold the cross products of coordinates of similar size exactly, so nothing is lost where segments are nearly
// parallel.
__extension__ using Quad = __float128;

bool opposite(double u, double v) {
  return (u < 0 && v > 0) || (u > 0 && v < 0);
}

bool in_box(const Point& p, const Point& a, const Point& b, double margin) {
  return p.x >= std::min(a.x, b.x) - margin && p.x <= std::max(a.x, b.x) + margin &&
         p.y >= std::min(a.y, b.y) - margin && p.y <= std::max(a.y, b.y) + margin;
}

// Clamped to both intervals, and rounded as input coordinates are.
double settle(double value, double a, double b, double c, double d) {
  const double low = std::max(std::min(a, b), std::min(c, d));
  const double high = std::min(std::max(a, b), std::max(c, d));
  const double inside = std::clamp(value, low, high);
  return rounded_to(inside, kInputGrid);
}

}  // namespace

OnSegment on_segment(const Point& p, const Point& a, const Point& b, double margin) {
  if (!in_box(p, a, b, margin)) return OnSegment::kNo;
  if (in_box(p, a, b, 0) && orient2d(a, b, p) == 0) return OnSegment::kExactly;
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double reach = margin * std::hypot(dx, dy);
  const double from_a = dx * (p.x - a.x) + dy * (p.y - a.y), to_b = dx * (b.x - p.x) + dy * (b.y - p.y);
  const bool beside = std::fabs(dx * (p.y - a.y) - dy * (p.x - a.x)) <= reach;
  return beside && from_a > reach && to_b > reach ? OnSegment::kClosely : OnSegment::kNo;
}

bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d) {
  return opposite(orient2d(a, b, c), orient2d(a, b, d)) && opposite(orient2d(c, d, a), orient2d(c, d, b));
}

Point crossing_point(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Quad abx = Quad(b.x) - a.x, aby = Quad(b.y) - a.y, cdx = Quad(d.x) - c.x, cdy = Quad(d.y) - c.y;
  const Quad t = ((Quad(c.x) - a.x) * cdy - (Quad(c.y) - a.y) * cdx) / (abx * cdy - aby * cdx);
  return {settle(static_cast<double>(a.x + t * abx), a.x, b.x, c.x, d.x),
          settle(static_cast<double>(a.y + t * aby), a.y, b.y, c.y, d.y)};
}

}  // namespace driftmesh
