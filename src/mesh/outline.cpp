#include "driftmesh/outline.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

/// The largest triangle that was offered, whose centroid is farthest from all borders, roughly.
class Largest {
 public:
  void offer(const CornerPoints& corners) {
    const double area = signed_area(corners[0], corners[1], corners[2]);
    if (!(area > area_)) return;
    area_ = area;
    at_ = centroid(corners);
  }
  [[nodiscard]] const Point& at() const { return at_; }

 private:
  double area_ = -1;
  Point at_{};
};

/// The segments of an outline, found at the triangles of a mesh.
class Borders {
 public:
  explicit Borders(const Mesh& mesh) : mesh_(mesh), neighbors_(triangle_neighbors(mesh)), index_(mesh) {}

  /// The triangle beyond edge `i` of triangle `t`, -1 if there is none.
  [[nodiscard]] std::int32_t beyond(std::size_t t, std::size_t i) const { return neighbors_[t][i]; }

  /// Whether the edge becomes a segment.
  [[nodiscard]] bool is_border(std::size_t t, std::size_t i) const {
    const std::int32_t other = beyond(t, i);
    if (other < 0 || listed(t, i) >= 0) return true;
    return !mesh_.regions.empty() && mesh_.regions[t] != mesh_.regions[to_index(other)];
  }

  [[nodiscard]] Pslg::Segment segment(std::size_t t, std::size_t i) const {
    const std::int32_t edge = listed(t, i);
    return {mesh_.triangles[t][(i + 1) % 3], mesh_.triangles[t][(i + 2) % 3],
            edge < 0 ? 0 : mesh_.edges[to_index(edge)].marker};
  }

 private:
  [[nodiscard]] std::int32_t listed(std::size_t t, std::size_t i) const {
    return index_.find(mesh_.triangles[t][(i + 1) % 3], mesh_.triangles[t][(i + 2) % 3]);
  }

  const Mesh& mesh_;
  TriangleNeighbors neighbors_;
  ConstrainedEdgeIndex index_;
};

/// Those that only one triangle has, or all.
std::vector<Pslg::Segment> segments_of(const Mesh& mesh, const Borders& borders, bool inner) {
  std::vector<Pslg::Segment> segments;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t other = borders.beyond(t, i);
      if (other < 0 || (inner && std::cmp_less(t, other) && borders.is_border(t, i)))
        segments.push_back(borders.segment(t, i));
    }
  return segments;
}

/// The points of the mesh at which there are segments, and these.
Pslg with_points_of(const Mesh& mesh, std::vector<Pslg::Segment> segments) {
  std::vector<std::int32_t> number(mesh.points.size(), kNone);
  for (const Pslg::Segment& s : segments) number[to_index(s.a)] = number[to_index(s.b)] = 0;
  Pslg pslg;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (number[i] == kNone) continue;
    number[i] = static_cast<std::int32_t>(pslg.points.size());
    pslg.points.push_back(mesh.points[i]);
    if (!mesh.point_markers.empty()) pslg.point_markers.push_back(mesh.point_markers[i]);
  }
  for (Pslg::Segment& s : segments) s = {number[to_index(s.a)], number[to_index(s.b)], s.marker};
  pslg.segments = std::move(segments);
  return pslg;
}

/// A seed in each area between borders that belongs to a region.
std::vector<Pslg::Region> regions_of(const Mesh& mesh, const Borders& borders) {
  std::vector<Pslg::Region> regions;
  if (mesh.regions.empty()) return regions;
  std::vector<bool> seen(mesh.triangles.size(), false);
  std::vector<std::size_t> stack;
  for (std::size_t first = 0; first < mesh.triangles.size(); ++first) {
    if (seen[first]) continue;
    Largest largest;
    seen[first] = true;
    stack = {first};
    while (!stack.empty()) {
      const std::size_t t = stack.back();
      stack.pop_back();
      const auto& [a, b, c] = mesh.triangles[t];
      largest.offer({mesh.points[to_index(a)], mesh.points[to_index(b)], mesh.points[to_index(c)]});
      for (std::size_t i = 0; i < 3; ++i) {
        if (borders.is_border(t, i)) continue;
        const std::size_t other = to_index(borders.beyond(t, i));
        if (!seen[other]) stack.push_back(other);
        seen[other] = true;
      }
    }
    if (mesh.regions[first] != 0) regions.push_back({largest.at(), mesh.regions[first], 0});
  }
  return regions;
}

/// What a boundary encloses: each part of it separates the inside from the outside.
struct Enclosed {
  double area = 0;
  std::vector<Point> holes;  ///< a point in each
};

Enclosed enclosed_by(const Triangulation& boundary) {
  IdVector<TriangleId, std::int8_t> inside(boundary.triangles.size(), -1);  // -1: not seen yet
  std::vector<TriangleId> fronts;                                           // where areas are entered
  for (const Subsegment& s : boundary.subsegments)
    for (const int side : {0, 1})
      if (s.half[side] != kNone && s.half[1 - side] == kNone) {
        inside[triangle_of(s.half[side])] = 1;
        fronts.push_back(triangle_of(s.half[side]));
      }
  Enclosed enclosed;
  IdVector<TriangleId, bool> done(boundary.triangles.size(), false);
  while (!fronts.empty()) {
    std::vector<TriangleId> stack{fronts.back()};
    fronts.pop_back();
    if (done[stack[0]]) continue;
    done[stack[0]] = true;
    const std::int8_t here = inside[stack[0]];
    Largest largest;
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      const CornerPoints corners{boundary.corner(t, 0), boundary.corner(t, 1), boundary.corner(t, 2)};
      largest.offer(corners);
      if (here == 1) enclosed.area += signed_area(corners[0], corners[1], corners[2]);
      for (int i = 0; i < 3; ++i) {
        const HalfEdge across = boundary.across(half_edge(t, i));
        if (across == kNone || done[triangle_of(across)]) continue;
        if (!is_constrained(boundary.twin(half_edge(t, i)))) {
          done[triangle_of(across)] = true;
          stack.push_back(triangle_of(across));
        } else if (inside[triangle_of(across)] < 0) {
          inside[triangle_of(across)] = static_cast<std::int8_t>(1 - here);
          fronts.push_back(triangle_of(across));
        }
      }
    }
    if (here == 0) enclosed.holes.push_back(largest.at());
  }
  return enclosed;
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += signed_area(mesh.points[to_index(a)], mesh.points[to_index(b)], mesh.points[to_index(c)]);
  return area;
}

}  // namespace

Pslg outline(const Mesh& mesh, const std::string& file) {
  if (mesh.triangles.empty()) throw InputError({file, 0}, "has no triangles", "an outline is that of triangles");
  const Borders borders(mesh);
  Pslg boundary = with_points_of(mesh, segments_of(mesh, borders, false));
  repair(boundary, file);
  const Enclosed enclosed = enclosed_by(triangulate(boundary));
  const double area = area_of(mesh);
  if (!(std::fabs(enclosed.area - area) <= 1e-6 * area))
    throw InputError({file, 0},
                     formatted("has triangles with an area of {}, but its boundary encloses {}", area, enclosed.area),
                     "look for triangles that overlap with driftmesh check");
  Pslg pslg = with_points_of(mesh, segments_of(mesh, borders, true));
  pslg.holes = enclosed.holes;
  pslg.regions = regions_of(mesh, borders);
  pslg.names = mesh.names;
  return pslg;
}

}  // namespace driftmesh
