#include "patch/part.hpp"

#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/link_triangles.hpp"

namespace driftmesh::patch {

Part part_of(const Mesh& mesh, std::vector<std::int32_t> triangles) {
  Part part;
  part.triangle = std::move(triangles);
  std::vector<std::int32_t> own(mesh.points.size(), kNone);  // the number of each point in the part
  for (const std::int32_t t : part.triangle)
    for (const std::int32_t v : mesh.triangles[to_index(t)]) own[to_index(v)] = 0;
  for (std::size_t v = 0; v < own.size(); ++v) {
    if (own[v] == kNone) continue;
    own[v] = static_cast<std::int32_t>(part.point.size());
    part.point.push_back(static_cast<std::int32_t>(v));
    part.mesh.points.push_back(mesh.points[v]);
    if (!mesh.point_markers.empty()) part.mesh.point_markers.push_back(mesh.point_markers[v]);
  }
  for (const std::int32_t t : part.triangle) {
    const auto& [a, b, c] = mesh.triangles[to_index(t)];
    part.mesh.triangles.push_back({own[to_index(a)], own[to_index(b)], own[to_index(c)]});
    if (!mesh.regions.empty()) part.mesh.regions.push_back(mesh.regions[to_index(t)]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b, marker] = mesh.edges[e];
    if (own[to_index(a)] == kNone || own[to_index(b)] == kNone) continue;
    part.edge.push_back(static_cast<std::int32_t>(e));
    part.mesh.edges.push_back({own[to_index(a)], own[to_index(b)], marker});
  }
  part.beyond = triangle_neighbors(part.mesh);
  return part;
}

namespace {

void link_or_refuse(Triangulation& made) {
  try {
    link_triangles(made);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "; look for the place with driftmesh check");
  }
}

}  // namespace

Triangulation triangulation_of(const Mesh& mesh, const TriangleNeighbors& beyond) {
  Triangulation made;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) made.add_vertex(mesh.points[v], static_cast<VertexOrigin>(v));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    auto& vertex = made.triangles[made.add_triangle()].vertex;
    for (int i = 0; i < 3; ++i) vertex[i] = VertexId{corners[to_index(i)]};
    for (std::size_t i = 0; i < 3; ++i)
      if (beyond[t][i] < 0) made.add_root(VertexId{corners[(i + 1) % 3]}, VertexId{corners[(i + 2) % 3]}, 0, kNone);
  }
  link_or_refuse(made);
  return made;
}

}  // namespace driftmesh::patch
