#include "adapt/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/box.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

/// The place of p along the line through a and b, 0 to 1 between them.
double along(const Point& a, const Point& b, const Point& p) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
}

/// How far beyond an edge of this length rounding may put a point.
double rounding_at(const Point& p, double length) {
  constexpr double kRounding = 1e-15, kNear = 1e-9;
  return std::max(kNear * length, kRounding * std::max(std::fabs(p.x), std::fabs(p.y)));
}

}  // namespace

/// Where a walk ended.
struct Locator::Stop {
  TriangleId triangle{};
  std::array<double, 3> side{};  // twice the area between the point and the edge opposite each corner, with exact sign
  int least = 0;                 // which of them is the least; < 0: the point is beyond that edge
  bool beyond = false;           // by more than rounding
  [[nodiscard]] bool inside() const { return side[least] >= 0; }
};

Locator::Locator(const Triangulation& mesh) : mesh_(mesh) {
  const auto alive = std::ranges::find_if(mesh.triangles, [](const Triangle& t) { return t.alive(); });
  last_ = TriangleId(alive - mesh.triangles.begin());
}

/// The stop of a walk that ends there.
Locator::Stop Locator::seen_from(TriangleId t, const Point& p) const {
  Stop stop{t};
  const auto& v = mesh_.triangles[t].vertex;
  for (int i = 0; i < 3; ++i) stop.side[i] = orient2d(mesh_.points[v[next(i)]], mesh_.points[v[previous(i)]], p);
  stop.least = static_cast<int>(std::ranges::min_element(stop.side) - stop.side.begin());
  return stop;
}

/// Across the edge that separates the triangle most from the point, until there is none, or nothing beyond it.
Locator::Stop Locator::walk(TriangleId start, const Point& p, int most_steps) const {
  for (int step = 0;; ++step) {
    const Stop stop = seen_from(start, p);
    if (stop.inside() || step == most_steps) return stop;
    const HalfEdge beyond = mesh_.across(half_edge(stop.triangle, stop.least));
    if (beyond == kNone) return stop;
    start = triangle_of(beyond);
  }
}

/// More than walks take.
int Locator::most_steps() const {
  return 100 + 4 * static_cast<int>(std::sqrt(static_cast<double>(mesh_.triangles.size())));
}

/// Whether the point is inside, or outside by no more than rounding.
bool Locator::is_settled(const Stop& stop, const Point& p) const {
  if (stop.inside()) return true;
  const HalfEdge edge = half_edge(stop.triangle, stop.least);
  if (mesh_.across(edge) != kNone) return false;
  const Point &a = mesh_.points[mesh_.edge_start(edge)], &b = mesh_.points[mesh_.edge_end(edge)];
  const double length = std::sqrt(squared_distance(a, b)), t = along(a, b, p);
  return t >= 0 && t <= 1 && -stop.side[stop.least] <= rounding_at(p, length) * length;
}

void Locator::make_starts() const {
  Box box;
  for (const VertexId v : ids_of(mesh_.points))
    if (mesh_.origin[v] != kDeleted) box.extend(mesh_.points[v]);
  const double columns = std::ceil(std::sqrt(static_cast<double>(mesh_.live_triangles()) / 4));
  low_ = box.low;
  width_ = std::max(box.high.x - box.low.x, box.high.y - box.low.y) / columns;
  columns_ = static_cast<std::size_t>(columns);
  starts_.assign(columns_ * columns_, kNone);
  const auto column = [&](double from) { return std::min(static_cast<std::size_t>(from / width_), columns_ - 1); };
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    const Point c = centroid({mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)});
    starts_[column(c.y - low_.y) * columns_ + column(c.x - low_.x)] = t;
  }
}

/// kNone if no triangle is centered in the square of the point.
TriangleId Locator::start_near(const Point& p) const {
  if (starts_.empty()) make_starts();
  const auto column = [&](double from) {
    return static_cast<std::size_t>(std::clamp(from / width_, 0.0, static_cast<double>(columns_ - 1)));
  };
  return starts_[column(p.y - low_.y) * columns_ + column(p.x - low_.x)];
}

void Locator::index_all() const {
  std::vector<BackgroundMesh::Triangle> triangles;
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    const auto& [a, b, c] = mesh_.triangles[t].vertex;
    triangles.push_back({to_int(a), to_int(b), to_int(c)});
    in_all_.push_back(t);
  }
  all_ = std::make_shared<const BackgroundMesh>(std::vector<Point>(mesh_.points.begin(), mesh_.points.end()),
                                                std::move(triangles));
}

void Locator::make_rim() const {
  std::vector<Box> boxes;
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge edge = half_edge(t, i);
      if (mesh_.across(edge) != kNone) continue;
      rim_.push_back(edge);
      boxes.push_back(Box::of(std::array{mesh_.points[mesh_.edge_start(edge)], mesh_.points[mesh_.edge_end(edge)]}));
    }
  }
  rim_tree_ = BoxTree(boxes);
}

/// The stop of a point outside that is nearest to this edge.
Locator::Stop Locator::beyond_edge(HalfEdge edge, const Point& p) const {
  Stop stop = seen_from(triangle_of(edge), p);
  stop.least = index_of(edge);
  stop.side[stop.least] = std::min(stop.side[stop.least], -0.0);
  const Point &a = mesh_.points[mesh_.edge_start(edge)], &b = mesh_.points[mesh_.edge_end(edge)];
  const double rounding = rounding_at(p, std::sqrt(squared_distance(a, b)));
  stop.beyond = squared_distance_to_segment(p, a, b) > rounding * rounding;
  return stop;
}

/// From the nearest edge of the boundary on whose inner side the point is, unless one on whose outer side it is is
/// nearer: then it is outside, beyond that edge. Nothing: the walk ended at the boundary, or the nearest point is an
/// end of edges, which tells no sides.
std::optional<Locator::Stop> Locator::search_from_rim(const Point& p) const {
  if (rim_.empty()) make_rim();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto ends = [&](std::int32_t i) {
    return std::pair(mesh_.points[mesh_.edge_start(rim_[to_index(i)])],
                     mesh_.points[mesh_.edge_end(rim_[to_index(i)])]);
  };
  const auto distance = [&](std::int32_t i) {
    const auto [a, b] = ends(i);
    return squared_distance_to_segment(p, a, b);
  };
  const auto nearest_seen_from = [&](int side) {
    return rim_tree_.nearest(p, [&](std::int32_t i) {
      const auto [a, b] = ends(i);
      return side * orient2d(a, b, p) >= 0 ? distance(i) : kNever;
    });
  };
  const std::int32_t inner = nearest_seen_from(1), outer = nearest_seen_from(-1);
  if (outer < 0 || (inner >= 0 && distance(inner) <= distance(outer))) {
    const Stop stop = walk(triangle_of(rim_[to_index(inner)]), p, most_steps());
    return is_settled(stop, p) ? std::optional(stop) : std::nullopt;
  }
  const auto [a, b] = ends(outer);
  const double t = along(a, b, p);
  if (!(t > 0 && t < 1)) return {};
  return beyond_edge(rim_[to_index(outer)], p);
}

/// Among all triangles: one that contains the point, or else the one whose boundary edge is nearest.
Locator::Stop Locator::search_all(const Point& p) const {
  if (!all_) index_all();
  const TriangleId t = in_all_[to_index(all_->locate(p).triangle)];
  const Stop stop = seen_from(t, p);
  if (stop.inside()) return stop;
  int nearest = stop.least;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (mesh_.across(half_edge(t, i)) != kNone) continue;
    const double distance = squared_distance_to_segment(p, mesh_.corner(t, next(i)), mesh_.corner(t, previous(i)));
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return beyond_edge(half_edge(t, nearest), p);
}

Locator::Place Locator::place_at(const Stop& stop, const Point& p) const {
  Place place{.triangle = stop.triangle, .beyond = stop.beyond};
  const auto at_corner = [&](int i) {
    place.weight = {};
    place.weight[i] = 1;
    place.corner = i;
  };
  for (int i = 0; i < 3; ++i)
    if (mesh_.corner(stop.triangle, i) == p) {
      at_corner(i);
      return place;
    }
  const HalfEdge edge = half_edge(stop.triangle, stop.least);
  if (stop.side[stop.least] > 0) {
    const double all = stop.side[0] + stop.side[1] + stop.side[2];
    for (int i = 0; i < 3; ++i) place.weight[i] = stop.side[i] / all;
    return place;
  }
  const HalfEdge other = mesh_.across(edge);
  const HalfEdge chosen = other != kNone && triangle_of(other) < stop.triangle ? other : edge;
  const Point &a = mesh_.points[mesh_.edge_start(chosen)], &b = mesh_.points[mesh_.edge_end(chosen)];
  const double t = nearest_on_segment(p, a, b);
  place.triangle = triangle_of(chosen);
  place.weight[next(index_of(chosen))] = 1 - t;
  place.weight[previous(index_of(chosen))] = t;
  return place;
}

Locator::Place Locator::locate(const Point& p) const {
  constexpr int kShort = 8;
  Stop stop = walk(last_, p, kShort);
  if (!is_settled(stop, p)) {
    const TriangleId start = start_near(p);
    stop = walk(start != kNone ? start : stop.triangle, p, most_steps());
    if (!is_settled(stop, p)) {
      const std::optional<Stop> found = search_from_rim(p);
      stop = found ? *found : search_all(p);
    }
  }
  last_ = stop.triangle;
  return place_at(stop, p);
}

}  // namespace driftmesh::adapt
