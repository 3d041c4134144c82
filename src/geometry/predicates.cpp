#include "geometry/predicates.hpp"

#include "geometry/expansion.hpp"

namespace driftmesh {
namespace {

using exact::determinant;
using exact::Expansion;

/// p - origin, and whether this is exact. It usually is: neighboring points are close to each other compared with their
/// distance from zero, and then the difference of two doubles is a double.
struct Difference {
  double x;
  double y;
  bool exact;
};

Difference difference(const Point& p, const Point& origin) {
  const exact::Rounded x = exact::two_sum(p.x, -origin.x);
  const exact::Rounded y = exact::two_sum(p.y, -origin.y);
  return {x.value, y.value, x.error == 0 && y.error == 0};
}

/// The cross product of the position vectors of p and q.
Expansion<4> cross(const Point& p, const Point& q) {
  return determinant(p.x, p.y, q.x, q.y);
}

/// e (x^2 + y^2).
template <int M>
Expansion<8 * M> lifted(const Expansion<M>& e, double x, double y) {
  return e * x * x + e * y * y;
}

/// The determinant of rows (x, y, x^2 + y^2).
double incircle_of_exact_differences(const Difference& a, const Difference& b, const Difference& c) {
  const Expansion<32> from_a = lifted(determinant(b.x, b.y, c.x, c.y), a.x, a.y);
  const Expansion<32> from_b = lifted(determinant(c.x, c.y, a.x, a.y), b.x, b.y);
  const Expansion<32> from_c = lifted(determinant(a.x, a.y, b.x, b.y), c.x, c.y);
  return (from_a + from_b + from_c).leading();
}

/// The determinant of rows (x, y, x^2 + y^2, 1), expanded by its third column: no difference of coordinates
/// occurs.
double incircle_of_coordinates(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Expansion<4> ab = cross(a, b), bc = cross(b, c), cd = cross(c, d), da = cross(d, a);
  const Expansion<4> ac = cross(a, c), bd = cross(b, d);
  const Expansion<96> from_a = lifted(bc + cd - bd, a.x, a.y);
  const Expansion<96> from_b = lifted(cd + da + ac, b.x, b.y);
  const Expansion<96> from_c = lifted(da + ab + bd, c.x, c.y);
  const Expansion<96> from_d = lifted(ab + bc - ac, d.x, d.y);
  return ((from_a - from_b) + (from_c - from_d)).leading();
}

}  // namespace

double orient2d_exact(const Point& a, const Point& b, const Point& c) {
  const Difference ac = difference(a, c), bc = difference(b, c);
  if (ac.exact && bc.exact) return determinant(ac.x, ac.y, bc.x, bc.y).leading();
  return (cross(a, b) + cross(b, c) + cross(c, a)).leading();
}

double incircle_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Difference ad = difference(a, d), bd = difference(b, d), cd = difference(c, d);
  if (ad.exact && bd.exact && cd.exact) return incircle_of_exact_differences(ad, bd, cd);
  return incircle_of_coordinates(a, b, c, d);
}

}  // namespace driftmesh
