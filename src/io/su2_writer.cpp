#include <array>
#include <initializer_list>
#include <map>
#include <string_view>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "io/file_sink.hpp"
#include "io/su2_format.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

// VTK's numbers of cell types, which SU2 uses.
constexpr int kSu2Line = 3;
constexpr int kSu2Triangle = 5;

void write_count(FileSink& sink, std::string_view name, std::size_t count) {
  sink.text(name);
  sink.text("= ");
  sink.number(count);
  sink.character('\n');
}

void write_numbers(FileSink& sink, std::initializer_list<std::int64_t> numbers) {
  char separator = '\0';
  for (const std::int64_t number : numbers) {
    if (separator != '\0') sink.character(separator);
    sink.number(number);
    separator = ' ';
  }
  sink.character('\n');
}

void write_boundaries(FileSink& sink, const Mesh& mesh) {
  const auto at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
  std::map<std::int32_t, std::vector<std::size_t>> of_marker;
  for (std::size_t e = 0; e < at_edges.size(); ++e)
    if ((at_edges[e][0] < 0) != (at_edges[e][1] < 0)) of_marker[mesh.edges[e].marker].push_back(e);
  write_count(sink, "NMARK", of_marker.size());
  for (const auto& [marker, edges] : of_marker) {
    sink.text("MARKER_TAG= ");
    sink.number(marker);
    sink.character('\n');
    write_count(sink, "MARKER_ELEMS", edges.size());
    for (const std::size_t e : edges) write_numbers(sink, {kSu2Line, mesh.edges[e].a, mesh.edges[e].b});
  }
}

}  // namespace

void write_su2(const Mesh& mesh, const std::string& path) {
  FileSink sink(path);
  sink.text("NDIME= 2\n");
  write_count(sink, "NELEM", mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    write_numbers(sink, {kSu2Triangle, a, b, c, static_cast<std::int64_t>(t)});
  }
  write_count(sink, "NPOIN", mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    sink.number(mesh.points[v].x);
    sink.character(' ');
    sink.number(mesh.points[v].y);
    sink.character(' ');
    sink.number(v);
    sink.character('\n');
  }
  write_boundaries(sink, mesh);
  sink.commit();
}

}  // namespace driftmesh
