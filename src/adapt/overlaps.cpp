#include "adapt/overlaps.hpp"

#include <utility>

#include "base/assert.hpp"

namespace driftmesh::adapt {
namespace {

/// A side of a polygon that is on no edge of the new triangle.
constexpr int kOfOld = -1;

Point seen_from(const Point& origin, const Point& p) {
  return {p.x - origin.x, p.y - origin.y};
}

}  // namespace

void OverlapSearch::CommonPolygon::push_back(const Point& p, int edge) {
  DM_ASSERT(size_ < corners_.size());
  corners_[size_] = p;
  edge_[size_++] = edge;
}

/// Keeps what is to the left of an edge of the old triangle from a to b (Sutherland and Hodgman).
void OverlapSearch::cut_off(const CommonPolygon& polygon, const Point& a, const Point& b, CommonPolygon& kept) {
  std::array<double, CommonPolygon::kMostCorners> beside;
  for (std::size_t i = 0; i < polygon.size(); ++i) beside[i] = rounded_cross(a, b, polygon[i]);
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = polygon.after(i);
    const Point &p = polygon[i], &q = polygon[j];
    const bool from_left = beside[i] >= 0;
    if (from_left) kept.push_back(p, polygon.edge_at(i));
    if (from_left == (beside[j] >= 0)) continue;
    const double t = beside[i] / (beside[i] - beside[j]);
    kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)}, from_left ? kOfOld : polygon.edge_at(i));
  }
}

double OverlapSearch::area_of(const CommonPolygon& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) area += signed_area(polygon[0], polygon[i - 1], polygon[i]);
  return area;
}

OverlapSearch::OverlapSearch(const Triangulation& old_mesh, const Triangulation& new_mesh)
    : old_mesh_(old_mesh), new_mesh_(new_mesh), locator_(new_mesh), seen_(new_mesh.triangles.size(), 0) {}

void OverlapSearch::find(TriangleId old_triangle, Overlaps& found) {
  found.old_triangle = old_triangle;
  found.correction = 1;
  found.list.clear();
  found.corners.clear();
  const CornerPoints triangle{old_mesh_.corner(old_triangle, 0), old_mesh_.corner(old_triangle, 1),
                              old_mesh_.corner(old_triangle, 2)};
  ++search_;
  enter(locator_.locate(centroid(triangle)).triangle);
  while (!open_.empty()) {
    const TriangleId t = open_.back();
    open_.pop_back();
    const CommonPolygon& polygon = common(triangle, t);
    if (polygon.size() < 3) continue;
    if (const double area = area_of(polygon); area > 0) {
      const auto first = static_cast<std::uint32_t>(found.corners.size());
      found.corners.insert(found.corners.end(), polygon.begin(), polygon.end());
      found.list.push_back({t, first, static_cast<std::uint32_t>(found.corners.size()), area});
    }
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const int edge = polygon.edge_at(i);
      if (edge == kOfOld || polygon[i] == polygon[polygon.after(i)]) continue;
      if (const HalfEdge beyond = new_mesh_.across(half_edge(t, edge)); beyond != kNone) enter(triangle_of(beyond));
    }
  }
}

/// What the old triangle has in common with t; valid until the next call.
const OverlapSearch::CommonPolygon& OverlapSearch::common(const CornerPoints& old_triangle, TriangleId t) {
  const Point& origin = new_mesh_.corner(t, 0);
  CommonPolygon* polygon = &polygons_[0];
  CommonPolygon* other = &polygons_[1];
  polygon->clear();
  for (int i = 0; i < 3; ++i) polygon->push_back(seen_from(origin, new_mesh_.corner(t, i)), previous(i));
  const CornerPoints triangle{(*polygon)[0], (*polygon)[1], (*polygon)[2]};
  const CornerPoints old{seen_from(origin, old_triangle[0]), seen_from(origin, old_triangle[1]),
                         seen_from(origin, old_triangle[2])};
  for (int i = 0; i < 3; ++i) {
    const Point &a = old[next(i)], &b = old[previous(i)];
    const int left = (rounded_cross(a, b, triangle[0]) >= 0) + (rounded_cross(a, b, triangle[1]) >= 0) +
                     (rounded_cross(a, b, triangle[2]) >= 0);
    if (left == 3) continue;
    if (left == 0) polygon->clear();
    if (polygon->size() == 0) break;
    cut_off(*polygon, a, b, *other);
    std::swap(polygon, other);
  }
  return *polygon;
}

void OverlapSearch::enter(TriangleId t) {
  if (std::exchange(seen_[t], search_) != search_) open_.push_back(t);
}

}  // namespace driftmesh::adapt
