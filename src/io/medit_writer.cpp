#include <map>
#include <set>
#include <string_view>

#include "io/file_sink.hpp"
#include "io/medit_format.hpp"
#include "io/msh_groups.hpp"
#include "io/tag_comments.hpp"

namespace driftmesh {
namespace {

void begin_section(FileSink& sink, std::string_view section, std::size_t count) {
  sink.text(section);
  sink.line(count);
}

/// References of edges are the markers themselves, so that all named ones stand for themselves.
void write_comments(FileSink& sink, const Mesh& mesh, const std::map<double, std::int32_t>& region_tags) {
  std::map<double, std::int32_t> marker_tags;
  for (const auto& [marker, name] : mesh.names.markers) marker_tags[marker] = marker;
  write_tag_comments(sink, marker_tags, region_tags, mesh.names);
}

}  // namespace

void write_medit(const Mesh& mesh, const std::string& path) {
  std::set<double> regions(mesh.regions.begin(), mesh.regions.end());
  for (const auto& [region, name] : mesh.names.regions) regions.insert(region);
  const std::map<double, std::int32_t> region_tags = tags_of_values(regions);

  FileSink sink(path);
  sink.text("MeshVersionFormatted 2\n");
  write_comments(sink, mesh, region_tags);
  sink.text("\nDimension 2\n");
  begin_section(sink, "\nVertices\n", mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    sink.line(mesh.points[v].x, mesh.points[v].y, mesh.point_markers.empty() ? 0 : mesh.point_markers[v]);
  begin_section(sink, "\nEdges\n", mesh.edges.size());
  for (const Mesh::Edge& edge : mesh.edges) sink.line(edge.a + 1, edge.b + 1, edge.marker);
  begin_section(sink, "\nTriangles\n", mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    sink.line(a + 1, b + 1, c + 1, mesh.regions.empty() ? 0 : region_tags.at(mesh.regions[t]));
  }
  sink.text("\nEnd\n");
  sink.commit();
}

}  // namespace driftmesh
