#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "driftmesh/point.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {

// Constructions and measures of triangles in plain doubles. Nothing here decides topology: that is for predicates.hpp.
// Points are constructed relative to a corner, so errors are relative to the size of the triangle, not to its distance
// from the origin, and their coordinates are in the range of the predicates.

[[nodiscard]] inline double squared_distance(const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return dx * dx + dy * dy;
}

/// Positive for counterclockwise corners, but rounded: only orient2d gives the exact sign.
[[nodiscard]] inline double signed_area(const Point& a, const Point& b, const Point& c) {
  return 0.5 * ((a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x));
}

/// The corners of a triangle.
using CornerPoints = std::array<Point, 3>;

[[nodiscard]] inline Point centroid(const CornerPoints& t) {
  return {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3};
}

/// Positive if p is to the left of the line from a to b, but rounded: only orient2d gives the exact sign.
[[nodiscard]] inline double rounded_cross(const Point& a, const Point& b, const Point& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Whether p is in the closed counterclockwise triangle, up to rounding.
[[nodiscard]] inline bool contains(const CornerPoints& t, const Point& p) {
  return rounded_cross(t[0], t[1], p) >= 0 && rounded_cross(t[1], t[2], p) >= 0 && rounded_cross(t[2], t[0], p) >= 0;
}

/// Center of the circle through three points that are not collinear (otherwise the result is not finite, or arbitrary).
[[nodiscard]] inline Point circumcenter(const Point& a, const Point& b, const Point& c) {
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const double scale = 0.5 / (bx * cy - by * cx);
  return {snap_to_zero(a.x + (cy * bb - by * cc) * scale), snap_to_zero(a.y + (bx * cc - cx * bb) * scale)};
}

/// The distance of off-centers from the midpoint of the shortest edge, as a multiple of the edge: 0.475 cot(theta / 2)
/// for an angle bound theta in degrees. With 0.5 the new triangle would just meet the bound; 0.475 leaves room for
/// rounding and lowers the number of points (Shewchuk's choice in Triangle; the idea is Ungor's, "Off-centers", LATIN
/// 2004).
[[nodiscard]] inline double off_center_factor(double min_angle_degrees) {
  return 0.475 / std::tan(min_angle_degrees * (std::numbers::pi / 360));
}

/// The point on the bisector of the edge ab, on the side of the apex c, at the distance of the circumcenter or at
/// factor |ab| from the edge, whichever is nearer. For a counterclockwise triangle whose shortest edge is ab.
[[nodiscard]] inline Point off_center(const Point& a, const Point& b, const Point& c, double factor) {
  const double ax = a.x - c.x, ay = a.y - c.y, bx = b.x - c.x, by = b.y - c.y;
  // The circumcenter is cot(angle at c) / 2 = dot / (2 cross) edge lengths away from the edge.
  const double dot = ax * bx + ay * by, twice_cross = 2 * (ax * by - ay * bx);
  const double height = dot < factor * twice_cross ? dot / twice_cross : factor;
  const double ex = b.x - a.x, ey = b.y - a.y;
  return {snap_to_zero(a.x + (0.5 * ex - height * ey)), snap_to_zero(a.y + (0.5 * ey + height * ex))};
}

/// off_center on the shortest edge of a counterclockwise triangle, whichever it is.
[[nodiscard]] inline Point off_center_of_triangle(const Point& a, const Point& b, const Point& c, double factor) {
  const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
  if (ab <= bc && ab <= ca) return off_center(a, b, c, factor);
  return bc <= ca ? off_center(b, c, a, factor) : off_center(c, a, b, factor);
}

/// Whether p sees the segment ab at more than the apex angle: p lies strictly inside the lens of two circular arcs
/// through a and b. `cos_apex` is the cosine of that angle, -1 < cos_apex <= 0: 0 gives the diametral disk, -0.5 the
/// lens of 120 degrees. The ends are outside.
[[nodiscard]] inline bool in_diametral_lens(const Point& p, const Point& a, const Point& b, double cos_apex) {
  const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
  const double dot = ax * bx + ay * by;
  return dot < 0 && dot * dot > cos_apex * cos_apex * ((ax * ax + ay * ay) * (bx * bx + by * by));
}

/// The angle at b between ba and bc, in radians, 0 to pi.
[[nodiscard]] inline double angle_at(const Point& a, const Point& b, const Point& c) {
  const double ax = a.x - b.x, ay = a.y - b.y, cx = c.x - b.x, cy = c.y - b.y;
  return std::atan2(std::fabs(ax * cy - ay * cx), ax * cx + ay * cy);
}

/// Radians.
struct AngleRange {
  double smallest;
  double largest;
};

/// The smallest and the largest angle of a triangle.
[[nodiscard]] inline AngleRange angle_range(const Point& a, const Point& b, const Point& c) {
  const auto [smallest, largest] = std::minmax({angle_at(c, a, b), angle_at(a, b, c), angle_at(b, c, a)});
  return {smallest, largest};
}

}  // namespace driftmesh
