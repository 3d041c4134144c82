#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "decompose/decomposition.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::testing {

/// Whether the wall from u to w comes near a separator from a to b, by distances from points along this alone: each of
/// them keeps a hundredth of the separator's length from all else, or 0.346 of its distance to the nearer end if that
/// is less, `part` of that.
inline bool comes_near(const Point& a, const Point& b, const Point& u, const Point& w, double part = 1) {
  constexpr int kSteps = 50;
  const double length = std::sqrt(squared_distance(a, b));
  for (int k = 1; k < kSteps; ++k) {
    const double t = static_cast<double>(k) / kSteps;
    const double keep = part * length * std::min(0.01, 0.346 * std::min(t, 1 - t));
    const Point p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    if (squared_distance_to_segment(p, u, w) < 0.999 * keep * keep) return true;
  }
  return false;
}

/// A separator and a root or an isolated point that it does not meet but comes too near to, in words; empty if there is
/// none (see comes_near).
inline std::string separator_without_room(const Decomposition& d, double part = 1) {
  const auto text = [&](GlobalPointId v) {
    return "(" + std::to_string(d.points[v].x) + ", " + std::to_string(d.points[v].y) + ")";
  };
  for (const Decomposition::Root& separator : d.roots) {
    if (!separator.separator) continue;
    const Point &a = d.points[separator.a], &b = d.points[separator.b];
    const auto is_near = [&](const Point& u, const Point& w) { return comes_near(a, b, u, w, part); };
    const auto meets = [&](GlobalPointId v) { return v == separator.a || v == separator.b; };
    const std::string name = "separator " + text(separator.a) + " " + text(separator.b) + " beside ";
    for (const Decomposition::Root& root : d.roots)
      if (!meets(root.a) && !meets(root.b) && is_near(d.points[root.a], d.points[root.b]))
        return name + text(root.a) + " " + text(root.b);
    for (const GlobalPointId v : d.point_list)
      if (!meets(v) && is_near(d.points[v], d.points[v])) return name + text(v);
  }
  return "";
}

}  // namespace driftmesh::testing
