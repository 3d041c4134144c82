#include "io/vtu_ghosts.hpp"

#include <cstddef>
#include <cstdint>

#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

/// Removes `width` values for each thing that is not kept. Empty arrays stay empty.
template <class T>
void keep_only(const std::vector<bool>& kept, std::vector<T>& values, std::size_t width = 1) {
  if (values.empty()) return;
  std::size_t next = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t k = 0; kept[i] && k < width; ++k) values[next++] = values[i * width + k];
  values.resize(next);
}

void drop_triangles(Mesh& mesh, const std::vector<bool>& ghosts) {
  std::vector<bool> kept = ghosts;
  kept.flip();
  keep_only(kept, mesh.triangles);
  keep_only(kept, mesh.regions);
  keep_only(kept, mesh.subdomains);
  keep_only(kept, mesh.ranks);
}

void drop_edges(Mesh& mesh, const std::vector<bool>& ghosts) {
  const auto at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
  std::vector<bool> kept(mesh.edges.size());
  for (std::size_t e = 0; e < kept.size(); ++e) kept[e] = !ghosts[e] || at_edges[e][0] >= 0 || at_edges[e][1] >= 0;
  keep_only(kept, mesh.edges);
}

void drop_points(Mesh& mesh, const std::vector<bool>& kept) {
  std::vector<std::int32_t> place(kept.size());
  std::int32_t next = 0;
  for (std::size_t v = 0; v < kept.size(); ++v) place[v] = kept[v] ? next++ : -1;
  for (auto& triangle : mesh.triangles)
    for (std::int32_t& corner : triangle) corner = place[corner];
  for (Mesh::Edge& edge : mesh.edges) edge.a = place[edge.a], edge.b = place[edge.b];
  keep_only(kept, mesh.points);
  keep_only(kept, mesh.point_markers);
  keep_only(kept, mesh.numbers);
  keep_only(kept, mesh.attributes, static_cast<std::size_t>(mesh.attributes_per_point));
}

}  // namespace

void drop_ghosts(Mesh& mesh, const GhostCells& ghosts) {
  std::vector<bool> kept(mesh.points.size(), true);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (ghosts.triangles[t])
      for (const std::int32_t corner : mesh.triangles[t]) kept[corner] = false;
  drop_triangles(mesh, ghosts.triangles);
  drop_edges(mesh, ghosts.edges);
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t corner : triangle) kept[corner] = true;
  for (const Mesh::Edge& edge : mesh.edges) kept[edge.a] = kept[edge.b] = true;
  drop_points(mesh, kept);
}

}  // namespace driftmesh
