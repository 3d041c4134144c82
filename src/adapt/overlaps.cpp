#include "adapt/overlaps.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "adapt/locator.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

using Polygon = std::vector<Point>;

/// Keeps what is to the left of the line from a to b (Sutherland and Hodgman).
void cut_off(Polygon& polygon, const Point& a, const Point& b, Polygon& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = rounded_cross(a, b, p), at_q = rounded_cross(a, b, q);
    if (at_p >= 0) kept.push_back(p);
    if ((at_p >= 0) == (at_q >= 0)) continue;
    const double t = at_p / (at_p - at_q);
    kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
  }
  polygon.swap(kept);
}

double area_of(const Polygon& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) area += signed_area(polygon[0], polygon[i - 1], polygon[i]);
  return area;
}

/// Finds the old triangles that overlap one new triangle after another.
class Search {
 public:
  explicit Search(const Triangulation& mesh) : mesh_(mesh), locator_(mesh), seen_(mesh.triangles.size(), 0) {}

  /// From the triangle at the centroid on, across edges. Calls visit(old triangle, polygon).
  template <class Visit>
  void operator()(const CornerPoints& triangle, const Visit& visit) {
    ++search_;
    enter(locator_.locate(centroid(triangle)).triangle);
    while (!open_.empty()) {
      const TriangleId t = open_.back();
      open_.pop_back();
      polygon_.assign(triangle.begin(), triangle.end());
      for (int i = 0; i < 3 && !polygon_.empty(); ++i)
        cut_off(polygon_, mesh_.corner(t, i), mesh_.corner(t, next(i)), kept_);
      if (polygon_.size() < 3) continue;
      visit(t, polygon_);
      for (int i = 0; i < 3; ++i)
        if (const HalfEdge beyond = mesh_.across(half_edge(t, i)); beyond != kNone) enter(triangle_of(beyond));
    }
  }

 private:
  void enter(TriangleId t) {
    if (std::exchange(seen_[to_index(t)], search_) != search_) open_.push_back(t);
  }

  const Triangulation& mesh_;
  Locator locator_;
  std::vector<std::uint32_t> seen_;  // the last search that came to each triangle
  std::uint32_t search_ = 0;
  std::vector<TriangleId> open_;
  Polygon polygon_, kept_;
};

}  // namespace

std::vector<Overlap> overlaps_of(const Triangulation& old_mesh, const Triangulation& new_mesh,
                                 const std::function<bool(TriangleId)>& is_new) {
  std::vector<Overlap> all;
  Search search(old_mesh);
  for (const TriangleId t : ids_of(new_mesh.triangles)) {
    if (!new_mesh.triangles[t].alive() || !is_new(t)) continue;
    search({new_mesh.corner(t, 0), new_mesh.corner(t, 1), new_mesh.corner(t, 2)},
           [&](TriangleId old, const Polygon& polygon) {
             if (const double area = area_of(polygon); area > 0) all.push_back({old, t, polygon, area});
           });
  }
  return all;
}

}  // namespace driftmesh::adapt
