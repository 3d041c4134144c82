#include "geojson/vertices_on_edges.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "geojson/each_point.hpp"
#include "geometry/box.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/segment_geometry.hpp"
#include "pslg/closeness.hpp"
#include "pslg/near_segment.hpp"

namespace driftmesh {
namespace {

bool by_place(const Point& p, const Point& q) {
  return std::pair(p.x, p.y) < std::pair(q.x, q.y);
}

void sort_out(std::vector<Point>& points) {
  std::ranges::sort(points, by_place);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

class VerticesOnEdges {
 public:
  explicit VerticesOnEdges(GeoFeatures& features) : features_(features) {
    for (const GeoFeatures::Polygon& polygon : features.polygons)
      for (const PolygonRing& ring : polygon.rings) corners_.insert(corners_.end(), ring.begin(), ring.end());
    sort_out(corners_);
    for_each_point(features, [&](const Point& p) { points_.push_back(p); });
    sort_out(points_);
    std::vector<Box> boxes;
    for (const Point& p : points_) boxes.push_back({p, p});
    tree_ = BoxTree(boxes);
  }

  void insert() {
    for (GeoFeatures::Polygon& polygon : features_.polygons)
      for (PolygonRing& ring : polygon.rings) {
        insert_into(ring, true);
        note_guests(ring);
      }
    for (GeoFeatures::Line& line : features_.lines) insert_into(line.points, false);
  }

  void project(const std::function<Point(const Point&)>& projection) const {
    for_each_point(features_, [&](Point& p) {
      const auto guest = guests_.find(p);
      p = guest == guests_.end() ? projection(p) : on_edge(p, guest->second, projection);
    });
  }

 private:
  using Edge = std::pair<Point, Point>;

  static Point on_edge(const Point& p, const Edge& edge, const std::function<Point(const Point&)>& projection) {
    const double t = nearest_on_segment(p, edge.first, edge.second);
    const Point a = projection(edge.first), b = projection(edge.second);
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
  }

  void insert_into(std::vector<Point>& corners, bool closed) const {
    std::vector<Point> all;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      all.push_back(corners[i]);
      if (closed || i + 1 < corners.size())
        insert_between(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1], all);
    }
    corners = std::move(all);
  }

  void insert_between(const Point& a, const Point& b, std::vector<Point>& all) const {
    const auto first = static_cast<std::ptrdiff_t>(all.size());
    const double margin = Closeness()(a, b);
    tree_.search(NearSegment(a, b, margin), [&](std::int32_t i) {
      if (points_[i] != a && points_[i] != b && on_segment(points_[i], a, b, margin) != OnSegment::kNo)
        all.push_back(points_[i]);
    });
    std::sort(all.begin() + first, all.end(), [&](const Point& p, const Point& q) {
      return nearest_on_segment(p, a, b) < nearest_on_segment(q, a, b);
    });
  }

  /// The ring begins with a corner, and those between two corners lie on the edge that joins these.
  void note_guests(const PolygonRing& ring) {
    Point before = ring.front();
    for (std::size_t i = 0, next = 0; i < ring.size(); ++i) {
      if (is_corner(ring[i])) {
        before = ring[i];
        for (next = i + 1; next < ring.size() && !is_corner(ring[next]); ++next) continue;
      } else {
        guests_.try_emplace(ring[i], before, next < ring.size() ? ring[next] : ring.front());
      }
    }
  }

  [[nodiscard]] bool is_corner(const Point& p) const {
    return std::binary_search(corners_.begin(), corners_.end(), p, by_place);
  }

  GeoFeatures& features_;
  std::vector<Point> corners_;  // polygons have them, in the order of by_place
  std::vector<Point> points_;   // all features have them, in the same order
  BoxTree tree_;                // finds points_
  // Points that are no corners, each with the corners between which it lies on an edge.
  std::map<Point, Edge, decltype(&by_place)> guests_{by_place};
};

}  // namespace

void project_with_edges(GeoFeatures& features, const std::function<Point(const Point&)>& projection) {
  VerticesOnEdges vertices(features);
  vertices.insert();
  vertices.project(projection);
}

}  // namespace driftmesh
