#include "pslg/poly_file.hpp"

#include <filesystem>
#include <utility>

#include "base/read_file.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "pslg/record_scanner.hpp"
#include "pslg/triangle_files.hpp"

namespace driftmesh {
namespace {

void move_nodes(NodeTable&& nodes, Pslg& pslg) {
  pslg.points = std::move(nodes.points);
  pslg.point_markers = std::move(nodes.markers);
  pslg.attributes = std::move(nodes.attributes);
  pslg.attributes_per_point = nodes.attributes_per_point;
  pslg.first_number = nodes.first_number;
}

void require_points(const std::string& file, const NodeTable& nodes) {
  if (nodes.points.empty()) throw InputError({file, 0}, "has no vertices", "there is nothing to mesh");
}

Pslg pslg_of_points(const std::string& file, NodeTable&& nodes) {
  require_points(file, nodes);
  Pslg pslg;
  move_nodes(std::move(nodes), pslg);
  return pslg;
}

/// What a file is that a user may take for a domain, by its content or its name; empty if it may be one.
std::string other_kind_of_file(const std::string& path, std::string_view text) {
  const auto starts_with = [&](std::string_view start) { return text.substr(0, start.size()) == start; };
  if (starts_with("<?xml") || starts_with("<VTKFile")) return "a mesh file of VTK";
  if (starts_with("$MeshFormat")) return "a mesh file of Gmsh";
  if (starts_with("# driftmesh decomposition")) return "a decomposition";
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vtu" || extension == ".pvtu" || extension == ".msh") return "the name of a mesh file";
  if (extension == ".ele" || extension == ".edge" || extension == ".neigh" || extension == ".area")
    return "a part of a mesh in Triangle's files";
  return "";
}

void refuse_other_files(const std::string& path, std::string_view text) {
  const std::string kind = other_kind_of_file(path, text);
  if (!kind.empty())
    throw InputError({path, 0}, "is " + kind + ", and not a domain",
                     "name a .poly, or a .node of points; Triangle's files of a mesh include its .poly");
}

void scan_segments(RecordScanner& scanner, Pslg& pslg) {
  scanner.require_record("the number of segments", "add a line '0 0' if there are none");
  const std::int32_t count = scanner.header("the number of segments");
  const bool has_markers = scanner.optional_header("the number of boundary markers", 1) == 1;
  scanner.require_room(count, "segments", has_markers ? 4 : 3);
  pslg.segments.reserve(count);
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "segments");
    (void)scanner.integer("the segment number");
    auto& segment = pslg.segments.emplace_back();
    segment.a = scan_vertex(scanner, pslg.points.size(), pslg.first_number);
    segment.b = scan_vertex(scanner, pslg.points.size(), pslg.first_number);
    if (has_markers) segment.marker = scanner.integer("the boundary marker");
  }
}

void scan_holes(RecordScanner& scanner, Pslg& pslg) {
  scanner.require_record("the number of holes", "add a line '0' if there are none; the file may be truncated");
  const std::int32_t count = scanner.header("the number of holes");
  scanner.require_room(count, "holes", 3);
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "holes");
    (void)scanner.integer("the hole number");
    pslg.holes.push_back(scanner.point());
  }
}

// The section may be missing entirely.
void scan_regions(RecordScanner& scanner, Pslg& pslg) {
  if (!scanner.next_record()) return;
  const std::int32_t count = scanner.header("the number of regions");
  scanner.require_room(count, "regions", 4);
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "regions");
    (void)scanner.integer("the region number");
    auto& region = pslg.regions.emplace_back();
    region.at = scanner.point();
    region.attribute = scanner.number("the region attribute");
    region.max_area = scanner.has_field() ? scanner.number("the area bound") : region.attribute;
  }
}

/// Where a .poly without vertices has them.
std::string node_file_of(const std::string& file) {
  return std::filesystem::path(file).replace_extension(".node").string();
}

}  // namespace

void scan_seeds(RecordScanner& scanner, Pslg& pslg) {
  scan_holes(scanner, pslg);
  scan_regions(scanner, pslg);
  scanner.require_end();
}

Pslg parse_poly(const std::string& file, std::string_view text) {
  RecordScanner scanner(file, text);
  NodeTable nodes = scan_nodes(scanner);
  const bool is_of_mesh = nodes.points.empty();
  if (is_of_mesh) {
    if (is_standard_stream(file))
      throw InputError({file, 0}, "leaves its vertices to a .node file, but standard input has none beside it",
                       "include the vertices, or give the path of the .poly file");
    const std::string node_file = node_file_of(file);
    nodes = read_node(node_file);
    require_points(node_file, nodes);
  }
  Pslg pslg;
  move_nodes(std::move(nodes), pslg);
  scan_segments(scanner, pslg);
  if (is_of_mesh)
    std::erase_if(pslg.segments, [](const Pslg::Segment& segment) { return segment.marker == kSeparatorMarker; });
  scan_seeds(scanner, pslg);
  scanner.throw_problems();
  return pslg;
}

Pslg read_poly(const std::string& path) {
  const std::string text = read_file(path, kBeginsNumbers);
  refuse_other_files(path, text);
  if (path.ends_with(".node")) return pslg_of_points(path, parse_node(path, text));
  return parse_poly(path, text);
}

bool leaves_vertices_out(const std::string& path) {
  const std::string text = read_file(path, kBeginsNumbers);
  RecordScanner scanner(path, text);
  return scan_nodes(scanner).points.empty();
}

std::vector<std::string> poly_files(const std::string& path) {
  std::vector<std::string> files{path};
  if (is_standard_stream(path)) return files;
  std::error_code ignored;
  if (const std::string nodes = node_file_of(path); nodes != path && std::filesystem::exists(nodes, ignored))
    files.push_back(nodes);
  return files;
}

}  // namespace driftmesh
