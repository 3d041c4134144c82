#include "mesh/to_piece.hpp"

#include <algorithm>

namespace driftmesh {
namespace {

/// The place of every vertex of `mesh` in the piece: input points first, then the others as they are stored.
struct VertexOrder {
  IdVector<VertexId, std::int32_t> place;  // one for each vertex; kNone for free slots
  std::vector<VertexId> input_vertices;    // in the order of the input
  std::size_t count = 0;
};

VertexOrder order_vertices(const Triangulation& mesh, std::size_t input_points) {
  VertexOrder order;
  IdVector<VertexOrigin, VertexId> vertex_of_input(input_points, kNone);
  for (const VertexId v : ids_of(mesh.points))
    if (is_input(mesh.origin[v])) vertex_of_input[mesh.origin[v]] = v;
  order.place.assign(mesh.points.size(), kNone);
  std::int32_t next_place = 0;
  for (const VertexId v : vertex_of_input)
    if (v != kNone) {
      order.place[v] = next_place++;
      order.input_vertices.push_back(v);
    }
  for (const VertexId v : ids_of(mesh.points))
    if (order.place[v] == kNone && mesh.origin[v] != kDeleted) order.place[v] = next_place++;
  order.count = next_place;
  return order;
}

void fill_points(const Triangulation& mesh, const Pslg& pslg, const VertexOrder& order, Mesh& piece) {
  piece.points.resize(order.count);
  piece.point_markers.assign(order.count, 0);
  for (const VertexId v : ids_of(mesh.points))
    if (order.place[v] != kNone) piece.points[order.place[v]] = mesh.points[v];

  for (const Subsegment& s : mesh.subsegments)
    if (s.is_leaf())
      for (const VertexId v : s.vertex) {
        std::int32_t& marker = piece.point_markers[order.place[v]];
        if (marker == 0) marker = mesh.roots[s.root].marker;
      }
  if (!pslg.point_markers.empty())
    for (std::size_t k = 0; k < order.input_vertices.size(); ++k)
      piece.point_markers[k] = pslg.point_markers[mesh.origin[order.input_vertices[k]]];
}

void fill_attributes(const Triangulation& mesh, const Pslg& pslg, const VertexOrder& order, Mesh& piece) {
  const std::size_t width = pslg.attributes_per_point;
  piece.attributes_per_point = pslg.attributes_per_point;
  piece.attributes.assign(order.count * width, 0);
  for (std::size_t k = 0; k < order.input_vertices.size(); ++k) {
    const std::size_t point = mesh.origin[order.input_vertices[k]];
    std::copy_n(pslg.attributes.begin() + static_cast<std::ptrdiff_t>(point * width), width,
                piece.attributes.begin() + static_cast<std::ptrdiff_t>(k * width));
  }
}

void fill_triangles(const Triangulation& mesh, const Pslg& pslg, const VertexOrder& order, Mesh& piece) {
  piece.triangles.reserve(mesh.live_triangles());
  if (!mesh.region.empty()) piece.regions.reserve(mesh.live_triangles());
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const auto& v = mesh.triangles[t].vertex;
    piece.triangles.push_back({order.place[v[0]], order.place[v[1]], order.place[v[2]]});
    if (mesh.region.empty()) continue;
    const std::size_t label = mesh.region[t];
    piece.regions.push_back(label == 0 ? 0 : pslg.regions[label - 1].attribute);
  }
}

}  // namespace

Mesh to_piece(const Triangulation& mesh, const Pslg& pslg) {
  Mesh piece;
  const VertexOrder order = order_vertices(mesh, pslg.points.size());
  fill_points(mesh, pslg, order, piece);
  fill_attributes(mesh, pslg, order, piece);
  fill_triangles(mesh, pslg, order, piece);
  for (const Subsegment& s : mesh.subsegments)
    if (s.is_leaf())
      piece.edges.push_back({order.place[s.vertex[0]], order.place[s.vertex[1]], mesh.roots[s.root].marker});
  piece.names = pslg.names;
  return piece;
}

}  // namespace driftmesh
