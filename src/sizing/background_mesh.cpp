#include "sizing/background_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

void require_corners(const std::vector<BackgroundMesh::Triangle>& triangles, std::size_t point_count) {
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::int32_t corner : triangles[t])
      if (to_index(corner) >= point_count)
        throw Error("background mesh: triangle " + std::to_string(t) + " (counted from 0) has the corner " +
                    std::to_string(corner) + ", but there are " + std::to_string(point_count) + " points");
}

/// The middle of the part of ab that is in the triangle; nothing if there is no such part.
std::optional<Point> middle_inside(const CornerPoints& triangle, const Point& a, const Point& b) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at_a = rounded_cross(triangle[i], triangle[(i + 1) % 3], a);
    const double at_b = rounded_cross(triangle[i], triangle[(i + 1) % 3], b);
    if (at_a < 0 && at_b < 0) return std::nullopt;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  if (from >= to) return std::nullopt;
  const double t = (from + to) / 2;
  return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

}  // namespace

/// The edges of all triangles that have an area, sorted by their ends.
std::vector<BackgroundMesh::Edge> BackgroundMesh::edges() const {
  const auto visit = [&](const auto& take) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!has_area_[t]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
        take(Edge{std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), static_cast<std::uint8_t>(i), a < b});
      }
    }
  };
  // By the lower end first: there are few for each.
  std::vector<std::size_t> begin(points_.size() + 1, 0);
  visit([&](const Edge& edge) { ++begin[edge.low + 1]; });
  for (std::size_t i = 0; i < points_.size(); ++i) begin[i + 1] += begin[i];
  std::vector<Edge> edges(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  visit([&](const Edge& edge) { edges[next[edge.low]++] = edge; });
  for (std::size_t i = 0; i < points_.size(); ++i)
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(begin[i]),
              edges.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]), [](const Edge& e, const Edge& f) {
                return std::tie(e.high, e.rising, e.triangle) < std::tie(f.high, f.rising, f.triangle);
              });
  return edges;
}

BackgroundMesh::BackgroundMesh(std::vector<Point> points, std::vector<Triangle> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  require_corners(triangles_, points_.size());
  std::vector<Box> boxes(triangles_.size());
  has_area_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto index = static_cast<std::int32_t>(t);
    const double turn = orient2d(corner(index, 0), corner(index, 1), corner(index, 2));
    if (turn < 0) std::swap(triangles_[t][1], triangles_[t][2]);
    has_area_[t] = turn != 0;
    for (std::size_t i = 0; i < 3; ++i) boxes[t].extend(corner(index, i));
  }
  if (std::find(has_area_.begin(), has_area_.end(), true) == has_area_.end())
    throw Error("background mesh: no triangle has an area");
  triangle_tree_ = BoxTree(boxes);
  connect(edges());
}

/// Notes what lies across each edge. An edge is on the boundary when no triangle has it in the other direction.
void BackgroundMesh::connect(const std::vector<Edge>& edges) {
  neighbors_.assign(triangles_.size(), {-1, -1, -1});
  const auto across = [&](const Edge& edge) -> std::int32_t& { return neighbors_[edge.triangle][edge.corner]; };
  std::vector<Box> boxes;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last + 1) {
    last = first;
    while (last + 1 < edges.size() && edges[last + 1].same_ends(edges[first])) ++last;
    if (edges[first].rising == edges[last].rising) {
      boundary_.push_back(edges[first]);
      boxes.emplace_back();
      for (const std::int32_t end : {edges[first].low, edges[first].high}) boxes.back().extend(points_[end]);
    } else if (last == first + 1) {
      across(edges[first]) = edges[last].triangle;
      across(edges[last]) = edges[first].triangle;
    }
  }
  boundary_tree_ = BoxTree(boxes);
}

template <class Visit>
void BackgroundMesh::visit_triangles_with(const Point& p, Visit&& visit) const {
  triangle_tree_.visit_containing(p, [&](std::int32_t t) {
    const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const std::array<double, 3> opposite{orient2d(b, c, p), orient2d(c, a, p), orient2d(a, b, p)};
    // The signs are exact. All of them are 0 on the line of a triangle without area.
    const bool inside = opposite[0] >= 0 && opposite[1] >= 0 && opposite[2] >= 0;
    if (inside && opposite[0] + opposite[1] + opposite[2] > 0) visit(t, opposite);
  });
}

/// From a triangle beside the point across edges that separate them: the triangle that has it in its interior; -1 if
/// the point lies on an edge, or the way meets the boundary or is long.
BackgroundMesh::Place BackgroundMesh::walk_to(const Point& p) const {
  constexpr int kMaxSteps = 100;
  std::int32_t t = triangle_tree_.beside(p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const std::array<double, 3> opposite{orient2d(b, c, p), orient2d(c, a, p), orient2d(a, b, p)};
    const std::size_t least = std::min_element(opposite.begin(), opposite.end()) - opposite.begin();
    if (opposite[least] > 0) return {t, opposite};
    const std::int32_t next = neighbors_[t][(least + 1) % 3];
    if (opposite[least] == 0 || next < 0) break;
    t = next;
  }
  return {-1, {}};
}

BackgroundMesh::Place BackgroundMesh::locate(const Point& p) const {
  Place place = walk_to(p);
  if (place.triangle < 0)
    visit_triangles_with(p, [&](std::int32_t t, const std::array<double, 3>& opposite) {
      if (place.triangle < 0 || t < place.triangle) place = {t, opposite};
    });
  if (place.triangle < 0) return nearest_on_boundary(p);
  const double total = place.weight[0] + place.weight[1] + place.weight[2];
  for (double& w : place.weight) w /= total;
  return place;
}

bool BackgroundMesh::covers(const std::array<Point, 3>& triangle) const {
  return !uncovered(triangle);
}

bool BackgroundMesh::covers(const Box& box) const {
  if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return true;
  const Point right{box.high.x, box.low.y}, left{box.low.x, box.high.y};
  return covers({box.low, right, box.high}) && covers({box.low, box.high, left});
}

/// A triangle that is not covered has a corner outside, or an edge of the boundary passes through it.
std::optional<Point> BackgroundMesh::uncovered(const std::array<Point, 3>& triangle) const {
  const Box box = Box::of(triangle);
  const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  const double beside = 1e-7 * size, rounding = 1e-9 * size;
  for (const Point& p : triangle)
    if (is_outside(p, rounding)) return p;
  std::optional<Point> found;
  boundary_tree_.search([&](const Box& around) { return !found && around.overlaps(box); },
                        [&](std::int32_t e) {
                          const Edge& edge = boundary_[e];
                          const Point &a = corner(edge.triangle, edge.corner),
                                      &b = corner(edge.triangle, (edge.corner + 1U) % 3);
                          const std::optional<Point> m = middle_inside(triangle, a, b);
                          if (!m) return;
                          const double scale = beside / std::sqrt(squared_distance(a, b));
                          const Point p{m->x + scale * (b.y - a.y), m->y - scale * (b.x - a.x)};
                          if (contains(triangle, p) && is_outside(p, rounding)) found = p;
                        });
  return found;
}

bool BackgroundMesh::is_outside(const Point& p, double by_more_than) const {
  if (walk_to(p).triangle >= 0) return false;
  bool inside = false;
  visit_triangles_with(p, [&](std::int32_t, const auto&) { inside = true; });
  if (inside) return false;
  const Place place = nearest_on_boundary(p);
  Point nearest{0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    nearest.x += place.weight[i] * corner(place.triangle, i).x;
    nearest.y += place.weight[i] * corner(place.triangle, i).y;
  }
  return squared_distance(p, nearest) > by_more_than * by_more_than;
}

BackgroundMesh::Place BackgroundMesh::nearest_on_boundary(const Point& p) const {
  const auto ends = [&](const Edge& edge) {
    return std::pair(corner(edge.triangle, edge.corner), corner(edge.triangle, (edge.corner + 1U) % 3));
  };
  const std::int32_t nearest = boundary_tree_.nearest(p, [&](std::int32_t candidate) {
    const auto [a, b] = ends(boundary_[candidate]);
    return squared_distance_to_segment(p, a, b);
  });
  const Edge& edge = boundary_[nearest];
  const auto [a, b] = ends(edge);
  const double t = nearest_on_segment(p, a, b);
  Place place{edge.triangle, {}};
  place.weight[edge.corner] = 1 - t;
  place.weight[(edge.corner + 1U) % 3] = t;
  return place;
}

}  // namespace driftmesh
