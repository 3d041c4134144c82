#include "triangle/old_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

#include "driftmesh/error.hpp"
#include "driftmesh/mesh.hpp"
#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "mesh/bounds.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh::triangle {
namespace {

constexpr const char* kOldMesh = "the mesh to refine";

/// A little less than the bound, for readers who round differently.
constexpr double kMargin = 1e-12;

double doubled_area(const std::vector<Point>& points, const Pslg::Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &p = points[ring[i]], &q = points[ring[(i + 1) % ring.size()]];
    sum +=
        (p.x - points[ring[0]].x) * (q.y - points[ring[0]].y) - (q.x - points[ring[0]].x) * (p.y - points[ring[0]].y);
  }
  return sum;
}

/// Joins the directed boundary edges of one component to rings. As many edges leave each of their points as arrive.
std::vector<Pslg::Ring> rings_of(const std::vector<Pair>& edges) {
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> leaving;
  for (const auto& [a, b] : edges) leaving[a].push_back(b);
  std::vector<Pslg::Ring> rings;
  for (const auto& [start, unused] : edges) {
    if (leaving[start].empty()) continue;
    Pslg::Ring ring;
    for (std::int32_t at = start; !leaving[at].empty();) {
      ring.push_back(at);
      const std::int32_t next = leaving[at].back();
      leaving[at].pop_back();
      at = next;
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace

OldMesh::OldMesh(const Tables& tables) : tables_(tables) {
  const auto count = static_cast<std::int32_t>(tables.points.size());
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < tables.triangle_count(); ++t) {
    Corners corners;
    std::copy_n(tables.triangles.begin() + static_cast<std::ptrdiff_t>(t) * tables.corners, 3, corners.begin());
    for (const std::int32_t v : corners)
      if (v < 0 || v >= count)
        throw InputError({kOldMesh}, "triangle " + std::to_string(t) + " (from 0) has a corner that is no point",
                         "correct it");
    const Point &a = tables.points[corners[0]], &b = tables.points[corners[1]], &c = tables.points[corners[2]];
    if (orient2d(a, b, c) < 0) std::swap(corners[1], corners[2]);
    triangles_.push_back(corners);
    Box box;
    for (const Point& p : {a, b, c}) box.extend(p);
    boxes.push_back(box);
  }
  if (triangles_.empty())
    throw InputError({kOldMesh}, "has no triangles", "without the switch r, points are triangulated");
  tree_ = BoxTree(boxes);
}

std::vector<Pslg::Polygon> OldMesh::outline() const {
  Mesh mesh;
  mesh.points = tables_.points;
  mesh.triangles = triangles_;
  const TriangleNeighbors neighbors = triangle_neighbors(mesh);
  const std::vector<std::int32_t> component = parts_between_edges(mesh);
  std::vector<std::vector<Pair>> borders(*std::ranges::max_element(component) + 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (neighbors[t][i] < 0)
        borders[component[t]].push_back({triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3]});
  std::vector<Pslg::Polygon> polygons;
  for (const std::vector<Pair>& border : borders) {
    Pslg::Polygon polygon{.rings = rings_of(border)};
    const auto outer = std::ranges::max_element(
        polygon.rings, {}, [&](const Pslg::Ring& ring) { return std::fabs(doubled_area(tables_.points, ring)); });
    std::iter_swap(polygon.rings.begin(), outer);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

Pslg OldMesh::domain(bool segments) const {
  Pslg pslg;
  std::vector<std::int32_t> place(tables_.points.size(), -1);
  for (const Corners& corners : triangles_)
    for (const std::int32_t v : corners) place[v] = 0;
  const std::size_t width = tables_.attributes_per_point;
  pslg.attributes_per_point = tables_.attributes_per_point;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    place[v] = static_cast<std::int32_t>(pslg.points.size());
    pslg.points.push_back(tables_.points[v]);
    const auto attributes = tables_.point_attributes.begin() + static_cast<std::ptrdiff_t>(v * width);
    pslg.attributes.insert(pslg.attributes.end(), attributes, attributes + static_cast<std::ptrdiff_t>(width));
  }
  if (segments)
    for (std::size_t s = 0; s < tables_.segments.size(); ++s) {
      const auto [a, b] = tables_.segments[s];
      if (place[a] < 0 || place[b] < 0) continue;  // outside of the mesh
      pslg.segments.push_back({place[a], place[b], tables_.segment_markers.empty() ? 0 : tables_.segment_markers[s]});
    }
  pslg.polygons = outline();
  for (Pslg::Polygon& polygon : pslg.polygons)
    for (Pslg::Ring& ring : polygon.rings) {
      for (std::int32_t& v : ring) v = place[v];
      for (std::size_t i = 0; i < ring.size(); ++i) pslg.segments.push_back({ring[i], ring[(i + 1) % ring.size()], 0});
    }
  return pslg;
}

bool OldMesh::contains(std::int32_t t, const Point& p) const {
  const auto at = [&](int i) -> const Point& { return tables_.points[triangles_[t][i]]; };
  return orient2d(at(0), at(1), p) >= 0 && orient2d(at(1), at(2), p) >= 0 && orient2d(at(2), at(0), p) >= 0;
}

std::int32_t OldMesh::triangle_at(const Point& p) const {
  std::int32_t found = -1;
  visit_at(p, [&](std::int32_t t) { found = std::max(found, t); });
  return found;
}

AreaField::AreaField(const OldMesh& mesh, std::span<const double> areas) : mesh_(mesh) {
  for (const double area : areas)
    length_.push_back(area > 0 ? edge_of_twice_area(2 * area) * (1 - kMargin)
                               : std::numeric_limits<double>::infinity());
}

double AreaField::edge_length(const Point& p) const {
  double length = 0;
  mesh_.visit_at(p, [&](std::int32_t t) { length = std::max(length, length_[t]); });
  return length > 0 ? length : std::numeric_limits<double>::infinity();
}

}  // namespace driftmesh::triangle
