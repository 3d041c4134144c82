#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/id_vector.hpp"
#include "io/file_sink.hpp"
#include "io/msh_format.hpp"
#include "io/msh_groups.hpp"
#include "mesh/mesh_edges.hpp"

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

// Numbers distinct values from 0 in the order of their first occurrence. Values are equal if their bits are.
class DistinctValues {
 public:
  std::int32_t number(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    if (!values.empty() && bits == last_bits_) return last_number_;
    const auto [found, is_new] = numbers_.try_emplace(bits, static_cast<std::int32_t>(values.size()));
    if (is_new) values.push_back(value);
    last_bits_ = bits;
    last_number_ = found->second;
    return last_number_;
  }
  std::vector<double> values;

 private:
  std::unordered_map<std::uint64_t, std::int32_t> numbers_;
  std::uint64_t last_bits_ = 0;
  std::int32_t last_number_ = 0;
};

struct Box {
  double min_x = std::numeric_limits<double>::infinity();
  double min_y = min_x;
  double max_x = -min_x;
  double max_y = -min_x;
  void add(const Point& p) {
    min_x = std::min(min_x, p.x);
    min_y = std::min(min_y, p.y);
    max_x = std::max(max_x, p.x);
    max_y = std::max(max_y, p.y);
  }
};

// An entity of the file (a curve for each marker, a surface for each region), which is also a physical group.
struct Entity {
  std::int32_t tag = 0;
  std::string name;
  Box box;
  double value = 0;          // marker or region
  bool hides_value = false;  // neither name nor tag tells it
};

/// `names`: of markers or regions, which otherwise have the name that `number_name` makes.
template <class Value, class NumberName>
Entity make_entity(std::int32_t tag, Value value, const std::map<Value, std::string>& names,
                   const NumberName& number_name) {
  const auto name = names.find(value);
  if (name == names.end()) return {.tag = tag, .name = number_name(value), .box = {}};
  return {
      .tag = tag, .name = name->second, .box = {}, .value = static_cast<double>(value), .hides_value = tag != value};
}

// Which entity everything belongs to. Curves and surfaces are numbered from 0; a node on both belongs to the curve.
struct Classification {
  explicit Classification(const Mesh& mesh) {
    classify_edges(mesh);
    classify_triangles(mesh);
    find_boxes(mesh);
    classify_nodes(mesh);
    find_boundaries(mesh);
  }

  std::vector<Entity> curves;
  std::vector<Entity> surfaces;
  std::vector<std::int32_t> curve_of_edge;
  std::vector<std::int32_t> surface_of_triangle;
  std::vector<std::int32_t> entity_of_node;           // curves, then surfaces
  std::vector<std::vector<std::int32_t>> boundaries;  // the curves at each surface
  std::vector<std::array<std::int32_t, 2>> at_edges;  // triangles

 private:
  void classify_edges(const Mesh& mesh) {
    DistinctValues markers;
    curve_of_edge.reserve(mesh.edges.size());
    for (const Mesh::Edge& edge : mesh.edges) curve_of_edge.push_back(markers.number(edge.marker));
    const std::vector<std::int32_t> tags = group_tags(markers.values);
    for (std::size_t i = 0; i < tags.size(); ++i)
      curves.push_back(
          make_entity(tags[i], static_cast<std::int32_t>(markers.values[i]), mesh.names.markers, marker_group_name));
  }

  void classify_triangles(const Mesh& mesh) {
    surface_of_triangle.assign(mesh.triangles.size(), 0);
    if (mesh.regions.empty()) {
      surfaces.push_back({.tag = 1, .name = std::string(kDomainName), .box = {}});
      return;
    }
    DistinctValues regions;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) surface_of_triangle[t] = regions.number(mesh.regions[t]);
    const std::vector<std::int32_t> tags = group_tags(regions.values);
    for (std::size_t i = 0; i < tags.size(); ++i)
      surfaces.push_back(make_entity(tags[i], regions.values[i], mesh.names.regions, region_group_name));
  }

  void find_boxes(const Mesh& mesh) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      for (std::int32_t vertex : {mesh.edges[e].a, mesh.edges[e].b})
        curves[curve_of_edge[e]].box.add(mesh.points[vertex]);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::int32_t vertex : mesh.triangles[t]) surfaces[surface_of_triangle[t]].box.add(mesh.points[vertex]);
  }

  void classify_nodes(const Mesh& mesh) {
    const auto first_surface = static_cast<std::int32_t>(curves.size());
    entity_of_node.assign(mesh.points.size(), first_surface);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::int32_t vertex : mesh.triangles[t]) entity_of_node[vertex] = first_surface + surface_of_triangle[t];
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      for (std::int32_t vertex : {mesh.edges[e].a, mesh.edges[e].b}) entity_of_node[vertex] = curve_of_edge[e];
  }

  void find_boundaries(const Mesh& mesh) {
    boundaries.resize(surfaces.size());
    std::set<std::pair<std::int32_t, std::int32_t>> seen;
    at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
    for (std::size_t e = 0; e < at_edges.size(); ++e)
      for (std::int32_t triangle : at_edges[e]) {
        if (triangle < 0) continue;
        const std::int32_t surface = surface_of_triangle[triangle];
        if (seen.insert({surface, curve_of_edge[e]}).second) boundaries[surface].push_back(curve_of_edge[e]);
      }
  }
};

void write_format(MshOutput& out) {
  out.begin("MeshFormat");
  out.text().text(out.ascii() ? "4.1 0 8\n" : "4.1 1 8\n");
  if (!out.ascii()) out.integer(1);  // shows the byte order
  out.end("MeshFormat");
}

void write_group_names(FileSink& sink, const std::vector<Entity>& entities, int dimension) {
  for (const Entity& entity : entities) {
    sink.number(dimension);
    sink.character(' ');
    sink.number(entity.tag);
    sink.text(" \"");
    sink.text(entity.name);
    sink.text("\"\n");
  }
}

void write_physical_names(FileSink& sink, const Classification& classes) {
  sink.text("$PhysicalNames\n");
  sink.number(classes.curves.size() + classes.surfaces.size());
  sink.character('\n');
  write_group_names(sink, classes.curves, 1);
  write_group_names(sink, classes.surfaces, 2);
  sink.text("$EndPhysicalNames\n");
}

void write_entity(MshOutput& out, const Entity& entity, const Box& box) {
  out.integer(entity.tag);
  for (const double bound : {box.min_x, box.min_y, 0.0, box.max_x, box.max_y, 0.0}) out.real(bound);
  out.size(1);
  out.integer(entity.tag);  // the physical group has the tag of its entity
}

void write_entities(MshOutput& out, const Classification& classes) {
  out.begin("Entities");
  for (std::size_t count : {std::size_t{0}, classes.curves.size(), classes.surfaces.size(), std::size_t{0}})
    out.size(count);
  out.end_record();
  for (const Entity& curve : classes.curves) {
    write_entity(out, curve, curve.box);
    out.size(0);  // bounding points: the curve is a set of edges and may have any number of ends
    out.end_record();
  }
  for (std::size_t s = 0; s < classes.surfaces.size(); ++s) {
    const Entity& surface = classes.surfaces[s];
    write_entity(out, surface, surface.box.min_x <= surface.box.max_x ? surface.box : Box{0, 0, 0, 0});
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

void write_block_header(MshOutput& out, int dimension, const Entity& entity, std::int32_t type, std::size_t count) {
  out.integer(dimension);
  out.integer(entity.tag);
  out.integer(type);
  out.size(count);
  out.end_record();
}

void write_nodes(MshOutput& out, const Mesh& mesh, const Classification& classes) {
  out.begin("Nodes");
  write_section_counts(out, count_runs(classes.entity_of_node), mesh.points.size());
  for_each_run(classes.entity_of_node, [&](std::size_t first, std::size_t end) {
    const std::size_t g = to_index(classes.entity_of_node[first]);
    const bool is_curve = g < classes.curves.size();
    const Entity& entity = is_curve ? classes.curves[g] : classes.surfaces[g - classes.curves.size()];
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

void write_elements(MshOutput& out, const Mesh& mesh, const Classification& classes) {
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
  out.text().number(count);
  out.text().character('\n');
}

void write_value(MshOutput& out, std::size_t tag, double value) {
  out.integer(static_cast<std::int32_t>(tag));
  out.real(value);
  out.end_record();
}

void write_attribute(MshOutput& out, const Mesh& mesh, std::size_t k) {
  begin_view(out, "NodeData", "attribute " + std::to_string(k + 1), mesh.points.size());
  const std::size_t per_point = mesh.attributes_per_point;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) write_value(out, v + 1, mesh.attributes[v * per_point + k]);
  out.end("NodeData");
}

/// Where the triangles were made, as a view: physical groups would change what solvers load. Lines have the values of
/// an adjacent triangle, since there are readers that want one for every element.
void write_element_data(MshOutput& out, std::string_view name, const std::vector<std::int32_t>& of_triangles,
                        const std::vector<std::array<std::int32_t, 2>>& at_edges) {
  begin_view(out, "ElementData", name, of_triangles.size() + at_edges.size());
  std::size_t tag = 0;
  for (const std::int32_t value : of_triangles) write_value(out, ++tag, value);
  for (const auto& [left, right] : at_edges) {
    const std::int32_t triangle = left >= 0 ? left : right;
    write_value(out, ++tag, triangle >= 0 ? of_triangles[triangle] : 0);
  }
  out.end("ElementData");
}

void write_views(MshOutput& out, const Mesh& mesh, const Classification& classes) {
  for (std::int32_t k = 0; k < mesh.attributes_per_point; ++k) write_attribute(out, mesh, k);
  if (!mesh.subdomains.empty()) write_element_data(out, kSubdomainView, mesh.subdomains, classes.at_edges);
  if (!mesh.ranks.empty()) write_element_data(out, kRankView, mesh.ranks, classes.at_edges);
}

// As text even in a binary file: readers that do not know the section look for its end line by line.
void write_point_markers(FileSink& sink, const std::vector<std::int32_t>& markers) {
  sink.text("$DriftmeshPointMarkers\n");
  sink.number(markers.size() - std::count(markers.begin(), markers.end(), 0));
  sink.character('\n');
  for (std::size_t v = 0; v < markers.size(); ++v) {
    if (markers[v] == 0) continue;
    sink.number(v + 1);
    sink.character(' ');
    sink.number(markers[v]);
    sink.character('\n');
  }
  sink.text("$EndDriftmeshPointMarkers\n");
}

/// The markers and regions of groups whose names say something else and whose tags cannot be these values.
void write_values(FileSink& sink, const Classification& classes) {
  std::size_t hidden = 0;
  for (const auto* const entities : {&classes.curves, &classes.surfaces})
    hidden += static_cast<std::size_t>(std::ranges::count_if(*entities, &Entity::hides_value));
  if (hidden == 0) return;
  sink.text("$DriftmeshValues\n");
  sink.number(hidden);
  sink.character('\n');
  for (const auto& [dimension, entities] : {std::pair(1, &classes.curves), {2, &classes.surfaces}})
    for (const Entity& entity : *entities) {
      if (!entity.hides_value) continue;
      sink.number(dimension);
      sink.character(' ');
      sink.number(entity.tag);
      sink.character(' ');
      sink.number(entity.value);
      sink.character('\n');
    }
  sink.text("$EndDriftmeshValues\n");
}

}  // namespace

void write_msh(const Mesh& mesh, const std::string& path, bool ascii) {
  (void)narrow<std::int32_t>(mesh.edges.size() + mesh.triangles.size(), "elements of a .msh file");
  MshOutput out(path, ascii);
  const Classification classes(mesh);
  write_format(out);
  write_physical_names(out.text(), classes);
  write_entities(out, classes);
  write_nodes(out, mesh, classes);
  write_elements(out, mesh, classes);
  write_views(out, mesh, classes);
  write_values(out.text(), classes);
  if (!mesh.point_markers.empty()) write_point_markers(out.text(), mesh.point_markers);
  out.commit();
}

}  // namespace driftmesh
