#include "io/short_openings.hpp"

#include <cmath>
#include <set>

#include "io/boundary_types.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

double length_of(const BoundaryString& string, const std::vector<Point>& points) {
  const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(string.vertices[i])]; };
  double length = 0;
  for (std::size_t i = 1; i < string.vertices.size(); ++i)
    length += std::hypot(at(i).x - at(i - 1).x, at(i).y - at(i - 1).y);
  return length;
}

/// The least from 0 on that nothing has.
std::int32_t free_marker(const Mesh& mesh, const WriteOptions& options) {
  std::set<std::int32_t> taken(options.open_boundary.begin(), options.open_boundary.end());
  for (const Mesh::Edge& edge : mesh.edges) taken.insert(edge.marker);
  for (const auto& [marker, name] : mesh.names.markers) taken.insert(marker);
  std::int32_t free = 0;
  while (taken.contains(free)) ++free;
  return free;
}

}  // namespace

void close_short_openings(Mesh& mesh, const WriteOptions& options) {
  const EdgeTypes types(mesh, options.open_boundary, true);
  const Boundary boundary = boundary_of(
      mesh, [&](std::int32_t from, std::int32_t to, std::int32_t edge) { return types.of(from, to, edge); });
  const ConstrainedEdgeIndex edges(mesh);
  const std::int32_t land = free_marker(mesh, options);
  for (const BoundaryString& string : boundary.strings) {
    if (string.type != kOpenType || length_of(string, mesh.points) >= options.open_from) continue;
    for (std::size_t i = 1; i < string.vertices.size(); ++i)
      if (const std::int32_t edge = edges.find(string.vertices[i - 1], string.vertices[i]); edge >= 0)
        mesh.edges[static_cast<std::size_t>(edge)].marker = land;
  }
}

}  // namespace driftmesh
