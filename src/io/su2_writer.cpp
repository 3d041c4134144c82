#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "io/file_sink.hpp"
#include "io/su2_format.hpp"
#include "mesh/mesh_edges.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

void write_count(FileSink& sink, std::string_view name, std::size_t count) {
  sink.text(name);
  sink.text("= ");
  sink.line(count);
}

/// The edges of the boundary, by their markers.
using Boundaries = std::map<std::int32_t, std::vector<std::int32_t>>;

Boundaries boundaries_of(const Mesh& mesh) {
  Boundaries boundaries;
  for (const std::int32_t e : boundary_edges(mesh)) boundaries[mesh.edges[to_index(e)].marker].push_back(e);
  return boundaries;
}

/// One word: lists of markers in settings are separated by commas and blanks, and '%' begins a comment there.
std::string word_of(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return std::string_view(" ,()=%").find(c) != std::string_view::npos; }, '_');
  if (marker_from(name) || name == "SEND_RECEIVE") name.insert(name.begin(), '_');
  return name;
}

using Tags = std::map<std::int32_t, std::string>;

Tags tags_of(const Boundaries& boundaries, const Names& names) {
  Tags tags;
  std::set<std::string> taken;
  for (const auto& [marker, edges] : boundaries) {
    const auto name = names.markers.find(marker);
    std::string& tag = tags[marker] = name == names.markers.end() ? std::to_string(marker) : word_of(name->second);
    while (!taken.insert(tag).second) tag.append("_").append(std::to_string(marker));
  }
  return tags;
}

/// At the beginning, where SU2 looks for nothing but its keywords. Between markers it skips no comments.
void write_names(FileSink& sink, const Tags& tags, const Names& names) {
  for (const auto& [marker, tag] : tags) {
    const auto name = names.markers.find(marker);
    if (name == names.markers.end()) continue;
    sink.text(kSu2NameComment);
    sink.number(marker);
    for (const std::string& word : {tag, name->second}) {
      sink.character(' ');
      sink.text(word);
    }
    sink.character('\n');
  }
}

void write_boundaries(FileSink& sink, const Mesh& mesh, const Boundaries& boundaries, const Tags& tags) {
  write_count(sink, "NMARK", boundaries.size());
  for (const auto& [marker, edges] : boundaries) {
    sink.text("MARKER_TAG= ");
    sink.text(tags.at(marker));
    sink.character('\n');
    write_count(sink, "MARKER_ELEMS", edges.size());
    for (const std::int32_t e : edges) {
      const Mesh::Edge& edge = mesh.edges[to_index(e)];
      sink.line(kSu2Line, edge.a, edge.b);
    }
  }
}

}  // namespace

void write_su2(const Mesh& mesh, const std::string& path) {
  FileSink sink(path);
  const Boundaries boundaries = boundaries_of(mesh);
  const Tags tags = tags_of(boundaries, mesh.names);
  write_names(sink, tags, mesh.names);
  if (!mesh.coordinates.empty()) {
    sink.text(kSu2Coordinates);
    sink.text(mesh.coordinates);
    sink.character('\n');
  }
  sink.text("NDIME= 2\n");
  write_count(sink, "NELEM", mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sink.line(kSu2Triangle, mesh.triangles[t], t);
  write_count(sink, "NPOIN", mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) sink.line(mesh.points[v].x, mesh.points[v].y, v);
  write_boundaries(sink, mesh, boundaries, tags);
  sink.commit();
}

}  // namespace driftmesh
