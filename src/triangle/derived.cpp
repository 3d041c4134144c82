#include "triangle/derived.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/mesh.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh::triangle {
namespace {

std::array<std::int32_t, 3> corners_of(const Tables& mesh, std::size_t t) {
  return {mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]};
}

/// The ends of the edge opposite to corner i, with the triangle on its left.
Pair edge_of(const Tables& mesh, std::size_t t, std::size_t i) {
  const auto corners = corners_of(mesh, t);
  return {corners[(i + 1) % 3], corners[(i + 2) % 3]};
}

/// Calls visit(t, i) once for each edge: with the later one of its triangles, in the order of edges.
template <class Visit>
void for_each_edge(const Tables& mesh, const Visit& visit) {
  for (std::size_t t = 0; t < mesh.neighbors.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (mesh.neighbors[t][i] < static_cast<std::int32_t>(t)) visit(t, i);
}

/// The point where the values at the corners of triangle t, extended over the plane, are taken: its weights.
std::array<double, 3> weights_at(const Tables& mesh, const std::array<std::int32_t, 3>& corners, const Point& p) {
  const Point &a = mesh.points[corners[0]], &b = mesh.points[corners[1]], &c = mesh.points[corners[2]];
  const double all = signed_area(a, b, c);
  return {signed_area(p, b, c) / all, signed_area(a, p, c) / all, signed_area(a, b, p) / all};
}

void append_values(const Tables& mesh, const std::array<std::int32_t, 3>& corners, const std::array<double, 3>& weights,
                   std::vector<double>& values) {
  const std::size_t width = mesh.attributes_per_point;
  for (std::size_t k = 0; k < width; ++k) {
    double value = 0;
    for (std::size_t i = 0; i < 3; ++i)
      value += weights[i] * mesh.point_attributes[static_cast<std::size_t>(corners[i]) * width + k];
    values.push_back(value);
  }
}

}  // namespace

void add_edges(Tables& tables) {
  Mesh mesh;
  mesh.points = tables.points;
  for (std::size_t t = 0; t < tables.triangle_count(); ++t) mesh.triangles.push_back(corners_of(tables, t));
  for (std::size_t s = 0; s < tables.segments.size(); ++s)
    mesh.edges.push_back({tables.segments[s][0], tables.segments[s][1], tables.segment_markers[s]});
  tables.neighbors = triangle_neighbors(mesh);
  const ConstrainedEdgeIndex segments(mesh);
  tables.edges.clear();
  tables.edge_markers.clear();
  for_each_edge(tables, [&](std::size_t t, std::size_t i) {
    const Pair edge = edge_of(tables, t, i);
    const std::int32_t segment = segments.find(edge[0], edge[1]);
    const std::int32_t marker = segment < 0 ? 0 : mesh.edges[segment].marker;
    tables.edges.push_back(edge);
    tables.edge_markers.push_back(marker == 0 && tables.neighbors[t][i] < 0 ? 1 : marker);
  });
}

Voronoi voronoi_of(const Tables& mesh) {
  Voronoi voronoi;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corners = corners_of(mesh, t);
    const Point center = circumcenter(mesh.points[corners[0]], mesh.points[corners[1]], mesh.points[corners[2]]);
    voronoi.points.push_back(center);
    append_values(mesh, corners, weights_at(mesh, corners, center), voronoi.point_attributes);
  }
  for_each_edge(mesh, [&](std::size_t t, std::size_t i) {
    const Pair edge = edge_of(mesh, t, i);
    const Point &a = mesh.points[edge[0]], &b = mesh.points[edge[1]];
    const std::int32_t other = mesh.neighbors[t][i];
    voronoi.edges.push_back({static_cast<std::int32_t>(t), other});
    voronoi.directions.push_back(other >= 0 ? Point{0, 0} : Point{b.y - a.y, a.x - b.x});
  });
  return voronoi;
}

void add_midpoints(Tables& mesh) {
  const std::size_t width = mesh.attributes_per_point;
  std::vector<std::array<std::int32_t, 3>> middle(mesh.triangle_count());
  std::size_t edge = 0;
  for_each_edge(mesh, [&](std::size_t t, std::size_t i) {
    const auto [a, b] = edge_of(mesh, t, i);
    const auto point = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.push_back(midpoint(mesh.points[a], mesh.points[b]));
    if (!mesh.point_markers.empty()) mesh.point_markers.push_back(mesh.edge_markers[edge]);
    ++edge;
    for (std::size_t k = 0; k < width; ++k)
      mesh.point_attributes.push_back((mesh.point_attributes[static_cast<std::size_t>(a) * width + k] +
                                       mesh.point_attributes[static_cast<std::size_t>(b) * width + k]) /
                                      2);
    middle[t][i] = point;
    if (const std::int32_t other = mesh.neighbors[t][i]; other >= 0) {
      const auto back = std::ranges::find(mesh.neighbors[other], static_cast<std::int32_t>(t));
      middle[other][back - mesh.neighbors[other].begin()] = point;
    }
  });
  std::vector<std::int32_t> triangles;
  for (std::size_t t = 0; t < middle.size(); ++t) {
    const auto corners = corners_of(mesh, t);
    triangles.insert(triangles.end(), corners.begin(), corners.end());
    triangles.insert(triangles.end(), middle[t].begin(), middle[t].end());
  }
  mesh.triangles = std::move(triangles);
  mesh.corners = 6;
}

void jettison_points(Tables& mesh) {
  const std::size_t width = mesh.attributes_per_point;
  std::vector<std::int32_t> place(mesh.points.size(), -1);
  for (const std::int32_t v : mesh.triangles) place[v] = 0;
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    mesh.points[kept] = mesh.points[v];
    if (!mesh.point_markers.empty()) mesh.point_markers[kept] = mesh.point_markers[v];
    std::copy_n(mesh.point_attributes.begin() + static_cast<std::ptrdiff_t>(v * width), width,
                mesh.point_attributes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(kept) * width));
    place[v] = kept++;
  }
  mesh.points.resize(kept);
  if (!mesh.point_markers.empty()) mesh.point_markers.resize(kept);
  mesh.point_attributes.resize(static_cast<std::size_t>(kept) * width);
  for (std::int32_t& v : mesh.triangles) v = place[v];
  for (Pair& segment : mesh.segments)
    for (std::int32_t& v : segment) v = place[v];
}

}  // namespace driftmesh::triangle
