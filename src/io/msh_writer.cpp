#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/id_vector.hpp"
#include "io/file_sink.hpp"
#include "io/msh_classification.hpp"
#include "io/msh_format.hpp"
#include "io/msh_groups.hpp"

namespace driftmesh {
namespace {

// Element types of the format.
constexpr std::int32_t kLineType = 1;
constexpr std::int32_t kTriangleType = 2;

/// What the format is made of: numbers as raw bytes, or as text with a line for each record.
class MshOutput {
 public:
  MshOutput(const std::string& path, bool ascii) : sink_(path), ascii_(ascii) {}

  void integer(std::int32_t value) { number(value); }
  void size(std::size_t value) { number(std::uint64_t{value}); }
  void real(double value) { number(value); }
  void end_record() {
    if (ascii_ && std::exchange(within_, false)) sink_.character('\n');
  }

  /// Text in both forms.
  [[nodiscard]] FileSink& text() { return sink_; }
  void begin(std::string_view name) {
    sink_.character('$');
    sink_.text(name);
    sink_.character('\n');
  }
  void end(std::string_view name) {
    end_record();
    if (!ascii_) sink_.character('\n');
    sink_.text("$End");
    sink_.text(name);
    sink_.character('\n');
  }
  [[nodiscard]] bool ascii() const { return ascii_; }
  void commit() { sink_.commit(); }

 private:
  template <class Number>
  void number(Number value) {
    if (!ascii_) return sink_.raw(value);
    if (std::exchange(within_, true)) sink_.character(' ');
    sink_.number(value);
  }

  FileSink sink_;
  bool ascii_;
  bool within_ = false;  // a record
};

/// Calls block(first, end) for each run of items on one entity. Blocks that follow the order of the mesh number nodes
/// and elements as they stand in the file, which is what readers take values on them for.
template <class Block>
void for_each_run(const std::vector<std::int32_t>& entities, const Block& block) {
  for (std::size_t first = 0, end = 0; first < entities.size(); first = end) {
    while (end < entities.size() && entities[end] == entities[first]) ++end;
    block(first, end);
  }
}

std::size_t count_runs(const std::vector<std::int32_t>& entities) {
  std::size_t runs = 0;
  for_each_run(entities, [&](std::size_t, std::size_t) { ++runs; });
  return runs;
}

void write_format(MshOutput& out) {
  out.begin("MeshFormat");
  out.text().text(out.ascii() ? "4.1 0 8\n" : "4.1 1 8\n");
  if (!out.ascii()) out.integer(1);  // shows the byte order
  out.end("MeshFormat");
}

void write_group_names(FileSink& sink, const std::vector<MshEntity>& entities, int dimension) {
  for (const MshEntity& entity : entities) {
    sink.number(dimension);
    sink.character(' ');
    sink.number(entity.tag);
    sink.text(" \"");
    sink.text(entity.name);
    sink.text("\"\n");
  }
}

void write_physical_names(FileSink& sink, const MshClassification& classes) {
  sink.text("$PhysicalNames\n");
  sink.line(classes.curves.size() + classes.surfaces.size());
  write_group_names(sink, classes.curves, 1);
  write_group_names(sink, classes.surfaces, 2);
  sink.text("$EndPhysicalNames\n");
}

void write_entity(MshOutput& out, const MshEntity& entity, const Box& box) {
  out.integer(entity.tag);
  for (const double bound : {box.low.x, box.low.y, 0.0, box.high.x, box.high.y, 0.0}) out.real(bound);
  out.size(1);
  out.integer(entity.tag);  // the physical group has the tag of its entity
}

void write_entities(MshOutput& out, const MshClassification& classes) {
  out.begin("Entities");
  for (std::size_t count : {std::size_t{0}, classes.curves.size(), classes.surfaces.size(), std::size_t{0}})
    out.size(count);
  out.end_record();
  for (const MshEntity& curve : classes.curves) {
    write_entity(out, curve, curve.box);
    out.size(0);  // bounding points: the curve is a set of edges and may have any number of ends
    out.end_record();
  }
  for (std::size_t s = 0; s < classes.surfaces.size(); ++s) {
    const MshEntity& surface = classes.surfaces[s];
    write_entity(out, surface, surface.box.low.x <= surface.box.high.x ? surface.box : Box{{0, 0}, {0, 0}});
    out.size(classes.boundaries[s].size());
    for (std::int32_t curve : classes.boundaries[s]) out.integer(classes.curves[curve].tag);
    out.end_record();
  }
  out.end("Entities");
}

void write_section_counts(MshOutput& out, std::size_t blocks, std::size_t items) {
  out.size(blocks);
  out.size(items);
  out.size(items == 0 ? 0 : 1);  // smallest and largest tag
  out.size(items);
  out.end_record();
}

void write_block_header(MshOutput& out, int dimension, const MshEntity& entity, std::int32_t type, std::size_t count) {
  out.integer(dimension);
  out.integer(entity.tag);
  out.integer(type);
  out.size(count);
  out.end_record();
}

void write_nodes(MshOutput& out, const Mesh& mesh, const MshClassification& classes) {
  out.begin("Nodes");
  write_section_counts(out, count_runs(classes.entity_of_node), mesh.points.size());
  for_each_run(classes.entity_of_node, [&](std::size_t first, std::size_t end) {
    const std::size_t g = to_index(classes.entity_of_node[first]);
    const bool is_curve = g < classes.curves.size();
    const MshEntity& entity = is_curve ? classes.curves[g] : classes.surfaces[g - classes.curves.size()];
    write_block_header(out, is_curve ? 1 : 2, entity, 0, end - first);  // 0: without parameters on the entity
    for (std::size_t v = first; v < end; ++v) {
      out.size(v + 1);
      out.end_record();
    }
    for (std::size_t v = first; v < end; ++v) {
      for (const double coordinate : {mesh.points[v].x, mesh.points[v].y, 0.0}) out.real(coordinate);
      out.end_record();
    }
  });
  out.end("Nodes");
}

void write_element(MshOutput& out, std::size_t tag, std::initializer_list<std::int32_t> nodes) {
  out.size(tag);
  for (const std::int32_t node : nodes) out.size(to_index(node) + 1);
  out.end_record();
}

void write_elements(MshOutput& out, const Mesh& mesh, const MshClassification& classes) {
  out.begin("Elements");
  write_section_counts(out, count_runs(classes.surface_of_triangle) + count_runs(classes.curve_of_edge),
                       mesh.triangles.size() + mesh.edges.size());
  for_each_run(classes.surface_of_triangle, [&](std::size_t first, std::size_t end) {
    write_block_header(out, 2, classes.surfaces[classes.surface_of_triangle[first]], kTriangleType, end - first);
    for (std::size_t t = first; t < end; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      write_element(out, t + 1, {a, b, c});
    }
  });
  for_each_run(classes.curve_of_edge, [&](std::size_t first, std::size_t end) {
    write_block_header(out, 1, classes.curves[classes.curve_of_edge[first]], kLineType, end - first);
    for (std::size_t e = first; e < end; ++e)
      write_element(out, mesh.triangles.size() + e + 1, {mesh.edges[e].a, mesh.edges[e].b});
  });
  out.end("Elements");
}

/// The header of a view with one value for each of `count` nodes or elements.
void begin_view(MshOutput& out, std::string_view section, std::string_view name, std::size_t count) {
  out.begin(section);
  out.text().text("1\n\"");
  out.text().text(name);
  out.text().text("\"\n1\n0\n3\n0\n1\n");  // time 0; step 0, one component, and the number of values:
  out.text().line(count);
}

void write_value(MshOutput& out, std::size_t tag, double value) {
  out.integer(static_cast<std::int32_t>(tag));
  out.real(value);
  out.end_record();
}

void write_attribute(MshOutput& out, const Mesh& mesh, std::size_t k) {
  std::string name = "attribute " + std::to_string(k + 1);
  if (!mesh.attribute_names.empty()) name += ": " + mesh.attribute_names[k];
  begin_view(out, "NodeData", name, mesh.points.size());
  const std::size_t per_point = mesh.attributes_per_point;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) write_value(out, v + 1, mesh.attributes[v * per_point + k]);
  out.end("NodeData");
}

/// Values at triangles as a view; also where they were made: physical groups would change what solvers load. Lines have
/// the values of an adjacent triangle, since there are readers that want one for every element.
template <class Value>
void write_element_data(MshOutput& out, std::string_view name, const std::vector<Value>& of_triangles,
                        const std::vector<std::array<std::int32_t, 2>>& at_edges) {
  begin_view(out, "ElementData", name, of_triangles.size() + at_edges.size());
  std::size_t tag = 0;
  for (const Value value : of_triangles) write_value(out, ++tag, value);
  for (const auto& [left, right] : at_edges) {
    const std::int32_t triangle = left >= 0 ? left : right;
    write_value(out, ++tag, triangle >= 0 ? of_triangles[triangle] : Value{});
  }
  out.end("ElementData");
}

void write_views(MshOutput& out, const Mesh& mesh, const TriangleData& data, const MshClassification& classes) {
  for (std::int32_t k = 0; k < mesh.attributes_per_point; ++k) write_attribute(out, mesh, k);
  if (!mesh.subdomains.empty()) write_element_data(out, kSubdomainView, mesh.subdomains, classes.at_edges);
  if (!mesh.ranks.empty()) write_element_data(out, kRankView, mesh.ranks, classes.at_edges);
  for (const auto& [name, values] : data) write_element_data(out, name, values, classes.at_edges);
}

// As text even in a binary file: readers that do not know the section look for its end line by line.
void write_point_markers(FileSink& sink, const std::vector<std::int32_t>& markers) {
  sink.text("$DriftmeshPointMarkers\n");
  sink.line(markers.size() - std::count(markers.begin(), markers.end(), 0));
  for (std::size_t v = 0; v < markers.size(); ++v)
    if (markers[v] != 0) sink.line(v + 1, markers[v]);
  sink.text("$EndDriftmeshPointMarkers\n");
}

void write_coordinates(FileSink& sink, const std::string& coordinates) {
  if (coordinates.empty()) return;
  sink.text("$DriftmeshCoordinates\n");
  sink.text(coordinates);
  sink.text("\n$EndDriftmeshCoordinates\n");
}

/// The markers and regions of groups whose names say something else and whose tags cannot be these values.
void write_values(FileSink& sink, const MshClassification& classes) {
  std::size_t hidden = 0;
  for (const auto* const entities : {&classes.curves, &classes.surfaces})
    hidden += static_cast<std::size_t>(std::ranges::count_if(*entities, &MshEntity::hides_value));
  if (hidden == 0) return;
  sink.text("$DriftmeshValues\n");
  sink.line(hidden);
  for (const auto& [dimension, entities] : {std::pair(1, &classes.curves), {2, &classes.surfaces}})
    for (const MshEntity& entity : *entities)
      if (entity.hides_value) sink.line(dimension, entity.tag, entity.value);
  sink.text("$EndDriftmeshValues\n");
}

}  // namespace

void write_msh(const Mesh& mesh, const TriangleData& data, const std::string& path, bool ascii) {
  (void)narrow<std::int32_t>(mesh.edges.size() + mesh.triangles.size(), "elements of a .msh file");
  MshOutput out(path, ascii);
  const MshClassification classes(mesh);
  write_format(out);
  write_physical_names(out.text(), classes);
  write_entities(out, classes);
  write_nodes(out, mesh, classes);
  write_elements(out, mesh, classes);
  write_views(out, mesh, data, classes);
  write_values(out.text(), classes);
  write_coordinates(out.text(), mesh.coordinates);
  if (!mesh.point_markers.empty()) write_point_markers(out.text(), mesh.point_markers);
  out.commit();
}

}  // namespace driftmesh
