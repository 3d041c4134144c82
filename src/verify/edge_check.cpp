#include "verify/edge_check.hpp"

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

/// How far a point is inside the circumcircle of a triangle; negative: outside.
long double depth_in_circle(const Point& a, const Point& b, const Point& c, const Point& p) {
  const long double bx = static_cast<long double>(b.x) - a.x, by = static_cast<long double>(b.y) - a.y,
                    cx = static_cast<long double>(c.x) - a.x, cy = static_cast<long double>(c.y) - a.y;
  const long double twice = 2 * (bx * cy - by * cx), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const long double x = (cy * b2 - by * c2) / twice, y = (bx * c2 - cx * b2) / twice;  // the center, from a
  return std::hypot(x, y) -
         std::hypot(x - (static_cast<long double>(p.x) - a.x), y - (static_cast<long double>(p.y) - a.y));
}

}  // namespace

void Interfaces::add(const Interfaces& others) {
  edges += others.edges;
  not_delaunay += others.not_delaunay;
  between_ranks += others.between_ranks;
  subdomains.insert(others.subdomains.begin(), others.subdomains.end());
}

void EdgeCheck::check(std::int32_t u, std::int32_t v, const Side& left, const Side& right) {
  if (is_interface(left, right))
    note_interface(left, right, is_delaunay(u, v, left.apex, right.apex));
  else if (delaunay_.applies && !is_delaunay(u, v, left.apex, right.apex))
    report(u, v, left, right);
}

void EdgeCheck::append(const EdgeCheck& later) {
  findings_.append(later.findings_);
  interfaces_.add(later.interfaces_);
}

// The circumcircle test says nothing about an inverted triangle, which is a flaw of its own.
bool EdgeCheck::is_delaunay(std::int32_t u, std::int32_t v, std::int32_t p, std::int32_t q) const {
  return !(incircle(at(u), at(v), at(p), at(q)) > 0) || !(orient2d(at(u), at(v), at(p)) > 0) ||
         !(orient2d(at(v), at(u), at(q)) > 0) ||
         (delaunay_.slack > 0 && depth_in_circle(at(u), at(v), at(p), at(q)) <= delaunay_.slack);
}

void EdgeCheck::note_interface(const Side& left, const Side& right, bool delaunay) {
  ++interfaces_.edges;
  interfaces_.not_delaunay += delaunay ? 0 : 1;
  if (!mesh_.ranks.empty())
    interfaces_.between_ranks += mesh_.ranks[left.triangle] != mesh_.ranks[right.triangle] ? 1 : 0;
  const auto [low, high] = std::minmax(mesh_.subdomains[left.triangle], mesh_.subdomains[right.triangle]);
  interfaces_.subdomains.emplace(low, high);
}

void EdgeCheck::report(std::int32_t u, std::int32_t v, const Side& left, const Side& right) {
  const double inside = incircle(at(u), at(v), at(left.apex), at(right.apex));
  findings_.add(Flaw::kNotDelaunay, [&] {
    return edge_words(names_, u, v) +
           formatted(" between {} and {}: ", triangle_words(names_, left.triangle),
                     triangle_words(names_, right.triangle)) +
           formatted("{} lies inside the circumcircle of the first (incircle {}, expected <= 0)",
                     point_words(names_, right.apex), inside);
  });
}

}  // namespace driftmesh
