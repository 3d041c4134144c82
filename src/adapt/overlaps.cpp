#include "adapt/overlaps.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "adapt/locator.hpp"
#include "base/assert.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {

/// A side of a polygon that is on no edge of the old triangle.
constexpr int kOfNew = -1;

/// What a new triangle has in common with an old one.
class CommonPolygon {
 public:
  [[nodiscard]] const Point* begin() const { return corners_.data(); }
  [[nodiscard]] const Point* end() const { return corners_.data() + size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Point& operator[](std::size_t i) const { return corners_[i]; }
  /// The edge of the old triangle on which the side from corner i to the next one is.
  [[nodiscard]] int edge_at(std::size_t i) const { return edge_[i]; }
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 < size_ ? i + 1 : 0; }
  void clear() { size_ = 0; }
  void push_back(const Point& p, int edge) {
    DM_ASSERT(size_ < corners_.size());
    corners_[size_] = p;
    edge_[size_++] = edge;
  }

 private:
  std::array<Point, OverlapList::kMostCorners> corners_;
  std::array<int, OverlapList::kMostCorners> edge_;
  std::size_t size_ = 0;
};

namespace {

/// Keeps what is to the left of an edge from a to b (Sutherland and Hodgman).
void cut_off(const CommonPolygon& polygon, const Point& a, const Point& b, int edge, CommonPolygon& kept) {
  std::array<double, OverlapList::kMostCorners> beside;
  for (std::size_t i = 0; i < polygon.size(); ++i) beside[i] = rounded_cross(a, b, polygon[i]);
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = polygon.after(i);
    const Point &p = polygon[i], &q = polygon[j];
    const bool from_left = beside[i] >= 0;
    if (from_left) kept.push_back(p, polygon.edge_at(i));
    if (from_left == (beside[j] >= 0)) continue;
    const double t = beside[i] / (beside[i] - beside[j]);
    kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)}, from_left ? edge : polygon.edge_at(i));
  }
}

double area_of(const CommonPolygon& polygon) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) area += signed_area(polygon[0], polygon[i - 1], polygon[i]);
  return area;
}

}  // namespace

/// Finds the old triangles that overlap one new triangle after another.
class OverlapFinder::Search {
 public:
  explicit Search(const Triangulation& mesh) : mesh_(mesh), locator_(mesh), seen_(mesh.triangles.size(), 0) {}

  /// From the triangle at the centroid on, across the edges on which it overlaps both sides. Calls visit(old triangle,
  /// polygon).
  template <class Visit>
  void operator()(const CornerPoints& corners, const Visit& visit) {
    ++search_;
    enter(locator_.locate(centroid(corners)).triangle);
    origin_ = corners[0];
    const CornerPoints triangle{from_origin(corners[0]), from_origin(corners[1]), from_origin(corners[2])};
    while (!open_.empty()) {
      const TriangleId t = open_.back();
      open_.pop_back();
      const CommonPolygon& polygon = common(triangle, t);
      if (polygon.size() < 3) continue;
      visit(t, polygon);
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const int edge = polygon.edge_at(i);
        if (edge == kOfNew || polygon[i] == polygon[polygon.after(i)]) continue;
        if (const HalfEdge beyond = mesh_.across(half_edge(t, edge)); beyond != kNone) enter(triangle_of(beyond));
      }
    }
  }

 private:
  /// What the triangle has in common with t; valid until the next call.
  const CommonPolygon& common(const CornerPoints& triangle, TriangleId t) {
    CommonPolygon* polygon = &polygons_[0];
    CommonPolygon* other = &polygons_[1];
    polygon->clear();
    for (const Point& p : triangle) polygon->push_back(p, kOfNew);
    for (int i = 0; i < 3; ++i) {
      const Point a = from_origin(mesh_.corner(t, next(i))), b = from_origin(mesh_.corner(t, previous(i)));
      const int left = (rounded_cross(a, b, triangle[0]) >= 0) + (rounded_cross(a, b, triangle[1]) >= 0) +
                       (rounded_cross(a, b, triangle[2]) >= 0);
      if (left == 3) continue;
      if (left == 0) polygon->clear();
      if (polygon->size() == 0) break;
      cut_off(*polygon, a, b, i, *other);
      std::swap(polygon, other);
    }
    return *polygon;
  }

  [[nodiscard]] Point from_origin(const Point& p) const { return {p.x - origin_.x, p.y - origin_.y}; }

  void enter(TriangleId t) {
    if (std::exchange(seen_[to_index(t)], search_) != search_) open_.push_back(t);
  }

  const Triangulation& mesh_;
  Locator locator_;
  std::vector<std::uint32_t> seen_;  // the last search that came to each triangle
  std::uint32_t search_ = 0;
  Point origin_{};
  std::vector<TriangleId> open_;
  std::array<CommonPolygon, 2> polygons_;
};

OverlapFinder::OverlapFinder(const Triangulation& old_mesh, const Triangulation& new_mesh,
                             const std::function<bool(TriangleId)>& is_new)
    : new_mesh_(new_mesh), search_(std::make_unique<Search>(old_mesh)), is_left_(new_mesh.triangles.size(), false) {
  for (const TriangleId t : ids_of(new_mesh.triangles)) is_left_[t] = new_mesh.triangles[t].alive() && is_new(t);
}

OverlapFinder::~OverlapFinder() = default;

void OverlapFinder::enter(TriangleId t) {
  if (is_left_[t]) open_.push_back(t);
  is_left_[t] = false;
}

/// Whether one is open.
bool OverlapFinder::next_triangle() {
  for (; open_.empty() && first_ < is_left_.size(); ++first_) enter(static_cast<TriangleId>(first_));
  return !open_.empty();
}

bool OverlapFinder::find(std::size_t most, OverlapList& found) {
  if (!next_triangle()) return false;
  found.overlaps.clear();
  found.corners.clear();
  // As much as may come, of which only what comes takes memory: growing would take three times as much.
  found.overlaps.reserve(most);
  found.corners.reserve(5 * most);
  while (found.overlaps.size() < most && next_triangle()) {
    const TriangleId t = open_.back();
    open_.pop_back();
    (*search_)({new_mesh_.corner(t, 0), new_mesh_.corner(t, 1), new_mesh_.corner(t, 2)},
               [&](TriangleId old, const CommonPolygon& polygon) {
                 const double area = area_of(polygon);
                 if (!(area > 0)) return;
                 const auto begin = static_cast<std::uint32_t>(found.corners.size());
                 found.corners.insert(found.corners.end(), polygon.begin(), polygon.end());
                 found.overlaps.push_back({old, t, begin, static_cast<std::uint32_t>(found.corners.size()), area});
               });
    for (int i = 0; i < 3; ++i)
      if (const HalfEdge beyond = new_mesh_.across(half_edge(t, i)); beyond != kNone) enter(triangle_of(beyond));
  }
  return true;
}

}  // namespace driftmesh::adapt
