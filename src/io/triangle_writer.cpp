#include "base/staged_files.hpp"
#include "driftmesh/error.hpp"
#include "io/file_sink.hpp"
#include "io/triangle_format.hpp"
#include "mesh/mesh_edges.hpp"
#include "pslg/triangle_files.hpp"

namespace driftmesh {
namespace {

void write_node_lines(FileSink& sink, const Mesh& mesh) {
  const std::size_t per_point = mesh.attributes_per_point;
  const bool has_markers = !mesh.point_markers.empty();
  sink.line(mesh.points.size(), 2, per_point, has_markers ? 1 : 0);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const std::span attributes(mesh.attributes.data() + v * per_point, per_point);
    const std::span marker(mesh.point_markers.data() + (has_markers ? v : 0), has_markers ? 1 : 0);
    sink.line(v + 1, mesh.points[v].x, mesh.points[v].y, attributes, marker);
  }
}

void write_ele_lines(FileSink& sink, const Mesh& mesh) {
  sink.line(mesh.triangles.size(), 3, mesh.regions.empty() ? 0 : 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (mesh.regions.empty())
      sink.line(t + 1, a + 1, b + 1, c + 1);
    else
      sink.line(t + 1, a + 1, b + 1, c + 1, mesh.regions[t]);
  }
}

using Edges = std::vector<Mesh::Edge>;

void write_segments(FileSink& sink, const Mesh& mesh, const Edges& separators, const std::vector<Point>& holes) {
  sink.line(0, 2, mesh.attributes_per_point, mesh.point_markers.empty() ? 0 : 1);
  sink.line(mesh.edges.size() + separators.size(), 1);
  std::size_t number = 0;
  for (const Edges* edges : {&mesh.edges, &separators})
    for (const Mesh::Edge& edge : *edges) sink.line(++number, edge.a + 1, edge.b + 1, edge.marker);
  sink.line(holes.size());
  for (std::size_t i = 0; i < holes.size(); ++i) sink.line(i + 1, holes[i].x, holes[i].y);
}

// An edge of two triangles is listed with the later one, whose neighbor there has the smaller number; an edge of a
// single triangle has the neighbor -1.
bool lists_edge(const TriangleNeighbors& neighbors, std::size_t t, std::size_t i) {
  return neighbors[t][i] < static_cast<std::int32_t>(t);
}

bool is_separator(const Mesh& mesh, const TriangleNeighbors& neighbors, std::size_t t, std::size_t i) {
  const std::int32_t other = neighbors[t][i];
  return other >= 0 && !mesh.subdomains.empty() && mesh.subdomains[other] != mesh.subdomains[t];
}

void write_edges(FileSink& sink, const Mesh& mesh, const TriangleNeighbors& neighbors,
                 const ConstrainedEdgeIndex& index) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) count += lists_edge(neighbors, t, i) ? 1 : 0;
  sink.line(count, 1);
  std::size_t number = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      if (!lists_edge(neighbors, t, i)) continue;
      const std::int32_t a = mesh.triangles[t][(i + 1) % 3];
      const std::int32_t b = mesh.triangles[t][(i + 2) % 3];
      const std::int32_t edge = index.find(a, b);
      const std::int32_t unlisted = is_separator(mesh, neighbors, t, i) ? kSeparatorMarker : 0;
      sink.line(++number, a + 1, b + 1, edge < 0 ? unlisted : mesh.edges[edge].marker);
    }
}

void write_neighbors(FileSink& sink, const TriangleNeighbors& neighbors) {
  sink.line(neighbors.size(), 3);
  const auto numbered = [](std::int32_t t) { return t < 0 ? -1 : t + 1; };
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    sink.line(t + 1, numbered(neighbors[t][0]), numbered(neighbors[t][1]), numbered(neighbors[t][2]));
}

}  // namespace

void write_triangle_format(const Mesh& mesh, const std::string& stem, const std::vector<Point>& holes) {
  for (const Mesh::Edge& edge : mesh.edges)
    if (edge.marker == kSeparatorMarker)
      throw InputError({stem + ".poly"},
                       "marker " + std::to_string(kSeparatorMarker) + " of a segment stands for separators there",
                       "give the segment another marker, or write another format");
  StagedFiles together;
  FileSink nodes(stem + ".node");
  FileSink triangles(stem + ".ele");
  FileSink segments(stem + ".poly");
  FileSink edges(stem + ".edge");
  FileSink neighbor_file(stem + ".neigh");
  write_node_lines(nodes, mesh);
  write_ele_lines(triangles, mesh);
  const TriangleNeighbors neighbors = triangle_neighbors(mesh);
  const ConstrainedEdgeIndex index(mesh);
  write_segments(segments, mesh, separator_edges(mesh, neighbors, index, kSeparatorMarker), holes);
  write_edges(edges, mesh, neighbors, index);
  write_neighbors(neighbor_file, neighbors);
  for (FileSink* sink : {&nodes, &triangles, &segments, &edges, &neighbor_file}) sink->commit();
  together.commit();
}

}  // namespace driftmesh
