#include "app/triangle_files.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/staged_files.hpp"
#include "driftmesh/files.hpp"
#include "io/triangle_tables.hpp"
#include "pslg/triangle_files.hpp"

namespace driftmesh::app {
namespace {

using triangle::Tables;

/// The name without the extension, which says what the file is.
bool strip(std::string& name, const std::string& extension) {
  if (!name.ends_with(extension)) return false;
  name.resize(name.size() - extension.size());
  return true;
}

/// "bay.2" after "bay.1" and "bay.1" after "bay".
std::string after(const std::string& stem) {
  const std::size_t dot = stem.rfind('.');
  if (dot == std::string::npos || dot + 1 == stem.size()) return stem + ".1";
  int iteration = 0;
  const char* const end = stem.data() + stem.size();
  const auto read = std::from_chars(stem.data() + dot + 1, end, iteration);
  if (read.ec != std::errc() || read.ptr != end || iteration < 0) return stem + ".1";
  return stem.substr(0, dot + 1) + std::to_string(iteration + 1);
}

void take_points(NodeTable&& nodes, Tables& tables) {
  tables.points = std::move(nodes.points);
  tables.point_markers = std::move(nodes.markers);
  tables.point_attributes = std::move(nodes.attributes);
  tables.attributes_per_point = nodes.attributes_per_point;
}

void take_segments(const Pslg& pslg, Tables& tables) {
  for (const Pslg::Segment& segment : pslg.segments) {
    tables.segments.push_back({segment.a, segment.b});
    tables.segment_markers.push_back(segment.marker);
  }
  tables.holes = pslg.holes;
  tables.regions = pslg.regions;
}

void take_triangles(EleTable&& elements, Tables& tables) {
  for (const auto& corners : elements.triangles)
    tables.triangles.insert(tables.triangles.end(), corners.begin(), corners.end());
  tables.triangle_attributes = std::move(elements.attributes);
  tables.attributes_per_triangle = elements.attributes_per_triangle;
}

NodeLines node_lines(const Tables& mesh) {
  return {.points = mesh.points,
          .attributes = mesh.point_attributes,
          .attributes_per_point = static_cast<std::size_t>(mesh.attributes_per_point),
          .markers = mesh.point_markers};
}

template <class Write>
void write_file(const std::string& path, const Write& write) {
  FileSink sink(path);
  write(sink);
  sink.commit();
}

}  // namespace

TriangleFiles::TriangleFiles(std::string name, triangle::Switches& switches) : switches_(switches) {
  if (strip(name, ".poly")) {
    switches.pslg = true;
  } else if (strip(name, ".ele")) {
    switches.refine = true;
  } else if (strip(name, ".area")) {
    switches.refine = switches.quality = switches.given_areas = true;
  } else {
    strip(name, ".node");
  }
  source_ = std::move(name);
  target_ = switches.no_iteration ? source_ : after(source_);
}

std::string TriangleFiles::input(const char* extension) {
  std::string path = source_ + extension;
  files_.reads(path, "the input");
  return path;
}

Tables TriangleFiles::read() {
  Tables tables;
  if (!switches_.refine && switches_.pslg) {
    Pslg pslg = read_poly(input(".poly"));
    has_node_file_ = std::filesystem::exists(source_ + ".node") && leaves_vertices_out(source_ + ".poly");
    if (has_node_file_) files_.reads(source_ + ".node", "the input");
    first_number_ = pslg.first_number;
    take_segments(pslg, tables);
    take_points({.points = std::move(pslg.points),
                 .markers = std::move(pslg.point_markers),
                 .attributes = std::move(pslg.attributes),
                 .attributes_per_point = pslg.attributes_per_point},
                tables);
    return tables;
  }
  NodeTable nodes = read_node(input(".node"));
  first_number_ = nodes.first_number;
  if (switches_.refine) {
    take_triangles(read_ele(input(".ele"), nodes), tables);
    if (switches_.pslg) take_segments(read_poly(input(".poly")), tables);
    const bool bounded =
        switches_.given_areas && (switches_.max_area == 0 || std::filesystem::exists(source_ + ".area"));
    if (bounded) tables.triangle_areas = read_area(input(".area"), tables.triangle_count());
  }
  take_points(std::move(nodes), tables);
  return tables;
}

bool TriangleFiles::writes_points() const {
  const bool is_input = switches_.no_iteration && has_node_file_;
  return !switches_.no_points && !is_input;
}

bool TriangleFiles::writes_segments() const {
  const bool known = switches_.pslg || switches_.hull;
  return known && !switches_.no_segments && !switches_.no_iteration;
}

std::vector<std::string> TriangleFiles::outputs() {
  std::vector<std::string> paths;
  const auto add = [&](bool writes, const char* extension) {
    if (!writes) return;
    paths.push_back(output(extension));
    files_.writes(paths.back(), "the output");
  };
  add(writes_points(), ".node");
  add(!switches_.no_triangles, ".ele");
  add(writes_segments(), ".poly");
  add(switches_.edges, ".edge");
  add(switches_.neighbors, ".neigh");
  add(switches_.voronoi, ".v.node");
  add(switches_.voronoi, ".v.edge");
  add(switches_.geomview, ".off");
  return paths;
}

void TriangleFiles::write(const triangle::Result& result) const {
  const Tables& mesh = result.mesh;
  const std::int32_t first = first_number_;
  StagedFiles together;
  if (writes_points()) write_file(output(".node"), [&](FileSink& sink) { write_nodes(sink, node_lines(mesh), first); });
  if (!switches_.no_triangles)
    write_file(output(".ele"), [&](FileSink& sink) {
      write_elements(sink,
                     {.points = mesh.triangles,
                      .points_per_element = static_cast<std::size_t>(mesh.corners),
                      .attributes = mesh.triangle_attributes,
                      .attributes_per_element = static_cast<std::size_t>(mesh.attributes_per_triangle)},
                     first);
    });
  if (writes_segments()) write_segments(mesh);
  if (switches_.edges)
    write_file(output(".edge"), [&](FileSink& sink) { write_edges(sink, mesh.edges, mesh.edge_markers, first); });
  if (switches_.neighbors)
    write_file(output(".neigh"), [&](FileSink& sink) { write_neighbors(sink, mesh.neighbors, first); });
  if (switches_.voronoi) write_voronoi(result);
  if (switches_.geomview) write_geomview(mesh);
  together.commit();
}

void TriangleFiles::write_segments(const Tables& mesh) const {
  write_file(output(".poly"), [&](FileSink& sink) {
    sink.line(0, 2, mesh.attributes_per_point, switches_.no_markers ? 0 : 1);
    write_edges(sink, mesh.segments, mesh.segment_markers, first_number_);
    const auto number = [&](std::size_t i) { return first_number_ + static_cast<std::int64_t>(i); };
    sink.line(mesh.holes.size());
    for (std::size_t i = 0; i < mesh.holes.size(); ++i) sink.line(number(i), mesh.holes[i].x, mesh.holes[i].y);
    if (mesh.regions.empty()) return;
    sink.line(mesh.regions.size());
    for (std::size_t i = 0; i < mesh.regions.size(); ++i) {
      const Pslg::Region& region = mesh.regions[i];
      sink.line(number(i), region.at.x, region.at.y, region.attribute, region.max_area);
    }
  });
}

void TriangleFiles::write_voronoi(const triangle::Result& result) const {
  const triangle::Voronoi& voronoi = result.voronoi;
  write_file(output(".v.node"), [&](FileSink& sink) {
    write_nodes(sink,
                {.points = voronoi.points,
                 .attributes = voronoi.point_attributes,
                 .attributes_per_point = static_cast<std::size_t>(result.mesh.attributes_per_point),
                 .markers = {}},
                first_number_);
  });
  write_file(output(".v.edge"), [&](FileSink& sink) {
    sink.line(voronoi.edges.size(), 0);
    for (std::size_t e = 0; e < voronoi.edges.size(); ++e) {
      const auto [from, to] = voronoi.edges[e];
      const std::int64_t number = first_number_ + static_cast<std::int64_t>(e);
      if (to >= 0)
        sink.line(number, from + first_number_, to + first_number_);
      else
        sink.line(number, from + first_number_, -1, voronoi.directions[e].x, voronoi.directions[e].y);
    }
  });
}

void TriangleFiles::write_geomview(const Tables& mesh) const {
  write_file(output(".off"), [&](FileSink& sink) {
    sink.text("OFF\n");
    sink.line(mesh.points.size(), mesh.triangle_count(), mesh.edges.size());
    for (const Point& p : mesh.points) sink.line(p.x, p.y, 0);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      sink.line(3, std::span(mesh.triangles).subspan(t * mesh.corners, 3));
  });
}

}  // namespace driftmesh::app
