#include "base/staged_files.hpp"
#include "driftmesh/error.hpp"
#include "io/file_sink.hpp"
#include "io/triangle_format.hpp"
#include "io/triangle_tables.hpp"
#include "mesh/mesh_edges.hpp"
#include "pslg/triangle_files.hpp"

namespace driftmesh {
namespace {

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

void write_all_edges(FileSink& sink, const Mesh& mesh, const TriangleNeighbors& neighbors,
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
  write_nodes(nodes,
              {.points = mesh.points,
               .attributes = mesh.attributes,
               .attributes_per_point = static_cast<std::size_t>(mesh.attributes_per_point),
               .markers = mesh.point_markers},
              1);
  write_elements(triangles,
                 {.points = {mesh.triangles.empty() ? nullptr : mesh.triangles[0].data(), 3 * mesh.triangles.size()},
                  .attributes = mesh.regions,
                  .attributes_per_element = mesh.regions.empty() ? std::size_t{0} : 1},
                 1);
  const TriangleNeighbors neighbors = triangle_neighbors(mesh);
  const ConstrainedEdgeIndex index(mesh);
  write_segments(segments, mesh, separator_edges(mesh, neighbors, index, kSeparatorMarker), holes);
  write_all_edges(edges, mesh, neighbors, index);
  write_neighbors(neighbor_file, neighbors, 1);
  for (FileSink* sink : {&nodes, &triangles, &segments, &edges, &neighbor_file}) sink->commit();
  together.commit();
}

}  // namespace driftmesh
