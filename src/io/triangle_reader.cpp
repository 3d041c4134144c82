#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "io/read_checks.hpp"
#include "io/triangle_format.hpp"
#include "mesh/mesh_edges.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/record_scanner.hpp"
#include "pslg/triangle_files.hpp"

namespace driftmesh {
namespace {

using Edges = std::vector<Mesh::Edge>;

// The section "count has_markers" and its records "number a b marker", which .poly and .edge files share.
Edges scan_edges(RecordScanner& scanner, const NodeTable& nodes) {
  scanner.require_record("the number of edges", "the file may be truncated");
  const std::int32_t count = scanner.header("the number of edges");
  const bool has_markers = scanner.optional_header("the number of boundary markers", 1) == 1;
  scanner.require_room(count, "edges", has_markers ? 4 : 3);
  Edges edges(count);
  RowNumbers numbers("edge", "edges");
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "edges");
    numbers.scan(scanner, i);
    Mesh::Edge& edge = edges[i];
    edge.a = scan_vertex(scanner, nodes.points.size(), nodes.first_number);
    edge.b = scan_vertex(scanner, nodes.points.size(), nodes.first_number);
    if (has_markers) edge.marker = scanner.integer("the boundary marker");
  }
  return edges;
}

// A .poly that lists vertices of its own numbers its segments by them: it is an input, not part of the mesh.
std::optional<Edges> read_segments(const std::string& path, const NodeTable& nodes) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const std::string text = read_file(path);
  RecordScanner scanner(path, text);
  const bool has_own_vertices = !scan_nodes(scanner).points.empty();
  scanner.throw_problems();
  if (has_own_vertices) return std::nullopt;
  Edges edges = scan_edges(scanner, nodes);
  Pslg seeds;  // belong to the input
  scan_seeds(scanner, seeds);
  scanner.throw_problems();
  return edges;
}

Edges read_marked_edges(const std::string& path, const NodeTable& nodes) {
  if (!std::filesystem::exists(path)) return {};
  const std::string text = read_file(path);
  RecordScanner scanner(path, text);
  Edges edges = scan_edges(scanner, nodes);
  scanner.require_end();
  scanner.throw_problems();
  std::erase_if(edges, [](const Mesh::Edge& edge) { return edge.marker == 0; });
  return edges;
}

std::vector<double> last_attributes(EleTable&& elements) {
  const std::size_t per_triangle = elements.attributes_per_triangle;
  if (per_triangle <= 1) return std::move(elements.attributes);
  std::vector<double> last;
  last.reserve(elements.triangles.size());
  for (std::size_t i = per_triangle - 1; i < elements.attributes.size(); i += per_triangle)
    last.push_back(elements.attributes[i]);
  return last;
}

// A separator lies between parts, whose numbers take the place of the subdomains', which the files do not hold.
void take_out_separators(Mesh& mesh) {
  const auto is_separator = [](const Mesh::Edge& edge) { return edge.marker == kSeparatorMarker; };
  if (std::none_of(mesh.edges.begin(), mesh.edges.end(), is_separator)) return;
  mesh.subdomains = parts_between_edges(mesh);
  std::erase_if(mesh.edges, is_separator);
}

}  // namespace

Mesh read_triangle_format(const std::string& stem) {
  if (!std::filesystem::exists(stem + ".ele") && std::filesystem::exists(stem + ".poly"))
    throw InputError({stem + ".poly", 0}, "is a domain and no mesh: there is no " + stem + ".ele with its triangles",
                     "let driftmesh mesh make one of it");
  NodeTable nodes = read_node(stem + ".node");
  EleTable elements = read_ele(stem + ".ele", nodes);
  Mesh mesh;
  const std::optional<Edges> segments = read_segments(stem + ".poly", nodes);
  mesh.edges = segments ? *segments : read_marked_edges(stem + ".edge", nodes);
  mesh.points = std::move(nodes.points);
  mesh.point_markers = std::move(nodes.markers);
  mesh.attributes = std::move(nodes.attributes);
  mesh.attributes_per_point = nodes.attributes_per_point;
  mesh.triangles = std::move(elements.triangles);
  mesh.regions = last_attributes(std::move(elements));
  check_read_mesh(mesh, stem + ".ele");
  take_out_separators(mesh);
  return mesh;
}

}  // namespace driftmesh
