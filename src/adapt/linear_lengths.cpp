#include "adapt/linear_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

double longest_edge(const CornerPoints& t) {
  return std::sqrt(
      std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])}));
}

/// Whether all of `one` is beyond an edge of `other`, up to rounding.
bool lies_beyond_an_edge(const CornerPoints& one, const CornerPoints& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a = other[i], &b = other[(i + 1) % 3];
    if (std::ranges::all_of(one, [&](const Point& p) { return rounded_cross(a, b, p) <= 0; })) return true;
  }
  return false;
}

/// How far along pq, 0 to 1, it crosses ab; less than 0 if it does not.
double crossing(const Point& p, const Point& q, const Point& a, const Point& b) {
  const double at_p = rounded_cross(a, b, p), at_q = rounded_cross(a, b, q);
  if ((at_p > 0) == (at_q > 0)) return -1;
  if ((rounded_cross(p, q, a) > 0) == (rounded_cross(p, q, b) > 0)) return -1;
  return at_p / (at_p - at_q);
}

}  // namespace

LinearLengths::LinearLengths(const Triangulation& mesh, const Lengths& lengths)
    : mesh_(mesh), lengths_(lengths), locator_(mesh) {}

void LinearLengths::look_over() const {
  if (std::exchange(looked_over_, true)) return;
  least_ = std::numeric_limits<double>::infinity();
  IdVector<TriangleId, double> slopes(mesh_.triangles.size(), 0);
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    for (const VertexId v : mesh_.triangles[t].vertex) least_ = std::min(least_, lengths_[v]);
    slopes[t] = steepness(t);
  }
  slopes_ = Slopes(mesh_, slopes);
}

double LinearLengths::least() const {
  look_over();
  return least_;
}

/// The slope of lengths in a triangle; infinite where one of them is.
double LinearLengths::steepness(TriangleId t) const {
  const auto& v = mesh_.triangles[t].vertex;
  const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
  const double ab = lengths_[v[1]] - lengths_[v[0]], ac = lengths_[v[2]] - lengths_[v[0]];
  const double area = rounded_cross(a, b, c);
  const double dx = (ab * (c.y - a.y) - ac * (b.y - a.y)) / area, dy = (ac * (b.x - a.x) - ab * (c.x - a.x)) / area;
  const double slope = std::sqrt(dx * dx + dy * dy);
  return slope >= 0 ? slope : std::numeric_limits<double>::infinity();  // not for NaN
}

double LinearLengths::at(const Locator::Place& place) const {
  double length = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (int i = 0; i < 3; ++i) {
    if (place.weight[i] == 0) continue;  // not 0 * infinity
    const double at_corner = lengths_[mesh_.triangles[place.triangle].vertex[i]];
    length += place.weight[i] * at_corner;
    shortest = std::min(shortest, at_corner);
    longest = std::max(longest, at_corner);
  }
  return std::clamp(length, shortest, longest);
}

double LinearLengths::edge_length(const Point& p) const {
  return at(locator_.locate(p));
}

/// No point of a triangle is farther from the nearest corner than in an equilateral one.
double LinearLengths::least_between(const std::array<Point, 3>& triangle, double at_corners) const {
  constexpr double kFarthest = 0.5774;  // above 1 / sqrt(3)
  look_over();
  const double least = at_corners - slopes_.most_in(Box::of(triangle)) * kFarthest * longest_edge(triangle);
  return least > 0 ? least : 0;
}

/// A function that is linear on triangles has its least value in another triangle at a corner of that, at a vertex, or
/// where edges cross. The corners have been looked at.
bool LinearLengths::falls_below_in(TriangleId t, const std::array<Point, 3>& triangle, double limit) const {
  for (int i = 0; i < 3; ++i) {
    const VertexId a = mesh_.triangles[t].vertex[i], b = mesh_.triangles[t].vertex[next(i)];
    const Point &p = mesh_.points[a], &q = mesh_.points[b];
    if (lengths_[a] < limit && contains(triangle, p)) return true;
    if (!(std::min(lengths_[a], lengths_[b]) < limit)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = crossing(p, q, triangle[k], triangle[(k + 1) % 3]);
      if (s >= 0 && (1 - s) * lengths_[a] + s * lengths_[b] < limit) return true;
    }
  }
  return false;
}

/// Looks at all triangles of the mesh that the triangle overlaps, from the one at its centroid on, unless lengths do
/// not change enough on the way from there to its corners.
bool LinearLengths::falls_below(const std::array<Point, 3>& triangle, double length) const {
  constexpr double kFarthest = 2.0 / 3;  // no corner is farther from the centroid than two thirds of the longest edge
  const double limit = length / kBetween;
  look_over();
  const Locator::Place middle = locator_.locate(centroid(triangle));
  if (at(middle) - slopes_.most_in(Box::of(triangle)) * kFarthest * longest_edge(triangle) >= limit) return false;
  if (seen_.empty() || ++search_ == 0) {
    seen_.assign(mesh_.triangles.size(), 0);
    search_ = 1;
  }
  open_.assign(1, middle.triangle);
  seen_[to_index(middle.triangle)] = search_;
  while (!open_.empty()) {
    const TriangleId t = open_.back();
    open_.pop_back();
    if (falls_below_in(t, triangle, limit)) return true;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge beyond = mesh_.across(half_edge(t, i));
      if (beyond == kNone) continue;
      const TriangleId u = triangle_of(beyond);
      if (std::exchange(seen_[to_index(u)], search_) == search_) continue;
      if (!lies_beyond_an_edge({mesh_.corner(u, 0), mesh_.corner(u, 1), mesh_.corner(u, 2)}, triangle))
        open_.push_back(u);
    }
  }
  return false;
}

}  // namespace driftmesh::adapt
