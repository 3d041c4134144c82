#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "base/narrow.hpp"
#include "driftmesh/id_vector.hpp"
#include "io/file_sink.hpp"
#include "io/msh_format.hpp"
#include "io/msh_groups.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

// Element types of the format, and the binary records of its sections.
constexpr std::int32_t kLineType = 1;
constexpr std::int32_t kTriangleType = 2;

// The items of each group in sequence, in their original order: items[first[g]] to items[first[g + 1] - 1].
struct Grouping {
  Grouping(const std::vector<std::int32_t>& group_of_item, std::size_t groups) : first(groups + 1, 0) {
    for (std::int32_t group : group_of_item) ++first[group + 1];
    for (std::size_t g = 0; g < groups; ++g) first[g + 1] += first[g];
    items.resize(group_of_item.size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < group_of_item.size(); ++i)
      items[next[group_of_item[i]]++] = static_cast<std::int32_t>(i);
  }
  [[nodiscard]] std::span<const std::int32_t> of(std::size_t group) const {
    return std::span(items).subspan(first[group], first[group + 1] - first[group]);
  }
  std::vector<std::size_t> first;
  std::vector<std::int32_t> items;
};

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
};

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

 private:
  void classify_edges(const Mesh& mesh) {
    DistinctValues markers;
    curve_of_edge.reserve(mesh.edges.size());
    for (const Mesh::Edge& edge : mesh.edges) curve_of_edge.push_back(markers.number(edge.marker));
    const std::vector<std::int32_t> tags = group_tags(markers.values);
    for (std::size_t i = 0; i < tags.size(); ++i)
      curves.push_back({tags[i], marker_group_name(static_cast<std::int32_t>(markers.values[i])), {}});
  }

  void classify_triangles(const Mesh& mesh) {
    surface_of_triangle.assign(mesh.triangles.size(), 0);
    if (mesh.regions.empty()) {
      surfaces.push_back({1, std::string(kDomainName), {}});
      return;
    }
    DistinctValues regions;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) surface_of_triangle[t] = regions.number(mesh.regions[t]);
    const std::vector<std::int32_t> tags = group_tags(regions.values);
    for (std::size_t i = 0; i < tags.size(); ++i)
      surfaces.push_back({tags[i], region_group_name(regions.values[i]), {}});
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
    const auto at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
    for (std::size_t e = 0; e < at_edges.size(); ++e)
      for (std::int32_t triangle : at_edges[e]) {
        if (triangle < 0) continue;
        const std::int32_t surface = surface_of_triangle[triangle];
        if (seen.insert({surface, curve_of_edge[e]}).second) boundaries[surface].push_back(curve_of_edge[e]);
      }
  }
};

// The text of a section header or of its end.
void section(FileSink& sink, std::string_view name) {
  sink.character('$');
  sink.text(name);
  sink.character('\n');
}

void end_of_binary_section(FileSink& sink, std::string_view name) {
  sink.character('\n');
  section(sink, name);
}

void write_size(FileSink& sink, std::size_t value) {
  sink.raw(std::uint64_t{value});
}

void write_format(FileSink& sink) {
  sink.text("$MeshFormat\n4.1 1 8\n");
  sink.raw(std::int32_t{1});
  sink.text("\n$EndMeshFormat\n");
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
  section(sink, "PhysicalNames");
  sink.number(classes.curves.size() + classes.surfaces.size());
  sink.character('\n');
  write_group_names(sink, classes.curves, 1);
  write_group_names(sink, classes.surfaces, 2);
  section(sink, "EndPhysicalNames");
}

void write_entity(FileSink& sink, const Entity& entity, const Box& box) {
  sink.raw(entity.tag);
  sink.raw(std::array<double, 6>{box.min_x, box.min_y, 0, box.max_x, box.max_y, 0});
  write_size(sink, 1);
  sink.raw(entity.tag);  // the physical group has the tag of its entity
}

void write_entities(FileSink& sink, const Classification& classes) {
  section(sink, "Entities");
  for (std::size_t count : {std::size_t{0}, classes.curves.size(), classes.surfaces.size(), std::size_t{0}})
    write_size(sink, count);
  for (const Entity& curve : classes.curves) {
    write_entity(sink, curve, curve.box);
    write_size(sink, 0);  // bounding points: the curve is a set of edges and may have any number of ends
  }
  for (std::size_t s = 0; s < classes.surfaces.size(); ++s) {
    const Entity& surface = classes.surfaces[s];
    write_entity(sink, surface, surface.box.min_x <= surface.box.max_x ? surface.box : Box{0, 0, 0, 0});
    write_size(sink, classes.boundaries[s].size());
    for (std::int32_t curve : classes.boundaries[s]) sink.raw(classes.curves[curve].tag);
  }
  end_of_binary_section(sink, "EndEntities");
}

std::size_t count_used(const Grouping& grouping) {
  std::size_t used = 0;
  for (std::size_t g = 0; g + 1 < grouping.first.size(); ++g) used += grouping.of(g).empty() ? 0 : 1;
  return used;
}

void write_section_counts(FileSink& sink, std::size_t blocks, std::size_t items) {
  write_size(sink, blocks);
  write_size(sink, items);
  write_size(sink, items == 0 ? 0 : 1);  // smallest and largest tag
  write_size(sink, items);
}

void write_nodes(FileSink& sink, const Mesh& mesh, const Classification& classes) {
  section(sink, "Nodes");
  const Grouping grouping(classes.entity_of_node, classes.curves.size() + classes.surfaces.size());
  write_section_counts(sink, count_used(grouping), mesh.points.size());
  for (std::size_t g = 0; g + 1 < grouping.first.size(); ++g) {
    const auto nodes = grouping.of(g);
    if (nodes.empty()) continue;
    const bool is_curve = g < classes.curves.size();
    const Entity& entity = is_curve ? classes.curves[g] : classes.surfaces[g - classes.curves.size()];
    sink.raw(std::array<std::int32_t, 3>{is_curve ? 1 : 2, entity.tag, 0});
    write_size(sink, nodes.size());
    for (std::int32_t node : nodes) write_size(sink, to_index(node) + 1);
    for (std::int32_t node : nodes) sink.raw(std::array<double, 3>{mesh.points[node].x, mesh.points[node].y, 0});
  }
  end_of_binary_section(sink, "EndNodes");
}

void write_block_header(FileSink& sink, int dimension, const Entity& entity, std::int32_t type, std::size_t count) {
  sink.raw(std::array<std::int32_t, 3>{dimension, entity.tag, type});
  write_size(sink, count);
}

void write_elements(FileSink& sink, const Mesh& mesh, const Classification& classes) {
  section(sink, "Elements");
  const Grouping edges(classes.curve_of_edge, classes.curves.size());
  const Grouping triangles(classes.surface_of_triangle, classes.surfaces.size());
  write_section_counts(sink, count_used(edges) + count_used(triangles), mesh.edges.size() + mesh.triangles.size());
  for (std::size_t c = 0; c < classes.curves.size(); ++c) {
    write_block_header(sink, 1, classes.curves[c], kLineType, edges.of(c).size());
    for (std::int32_t e : edges.of(c))
      sink.raw(
          std::array<std::uint64_t, 3>{to_index(e) + 1, to_index(mesh.edges[e].a) + 1, to_index(mesh.edges[e].b) + 1});
  }
  for (std::size_t s = 0; s < classes.surfaces.size(); ++s) {
    if (triangles.of(s).empty()) continue;
    write_block_header(sink, 2, classes.surfaces[s], kTriangleType, triangles.of(s).size());
    for (std::int32_t t : triangles.of(s)) {
      const auto& [a, b, c] = mesh.triangles[t];
      sink.raw(std::array<std::uint64_t, 4>{mesh.edges.size() + to_index(t) + 1, to_index(a) + 1, to_index(b) + 1,
                                            to_index(c) + 1});
    }
  }
  end_of_binary_section(sink, "EndElements");
}

void write_attribute(FileSink& sink, const Mesh& mesh, std::size_t k) {
  section(sink, "NodeData");
  sink.text("1\n\"attribute ");
  sink.number(k + 1);
  sink.text("\"\n1\n0\n3\n0\n1\n");  // time 0; step 0, one component, and the number of nodes:
  sink.number(mesh.points.size());
  sink.character('\n');
  const std::size_t per_point = mesh.attributes_per_point;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    sink.raw(static_cast<std::int32_t>(v + 1));
    sink.raw(mesh.attributes[v * per_point + k]);
  }
  end_of_binary_section(sink, "EndNodeData");
}

// Where the triangles were made, as a view of them: physical groups would change what solvers load.
void write_triangle_data(FileSink& sink, const Mesh& mesh, std::string_view name,
                         const std::vector<std::int32_t>& values) {
  section(sink, "ElementData");
  sink.text("1\n\"");
  sink.text(name);
  sink.text("\"\n1\n0\n3\n0\n1\n");  // as above
  sink.number(values.size());
  sink.character('\n');
  for (std::size_t t = 0; t < values.size(); ++t) {
    sink.raw(static_cast<std::int32_t>(mesh.edges.size() + t + 1));
    sink.raw(static_cast<double>(values[t]));
  }
  end_of_binary_section(sink, "EndElementData");
}

// As text even in a binary file: readers that do not know the section look for its end line by line.
void write_point_markers(FileSink& sink, const std::vector<std::int32_t>& markers) {
  section(sink, "DriftmeshPointMarkers");
  sink.number(markers.size() - std::count(markers.begin(), markers.end(), 0));
  sink.character('\n');
  for (std::size_t v = 0; v < markers.size(); ++v) {
    if (markers[v] == 0) continue;
    sink.number(v + 1);
    sink.character(' ');
    sink.number(markers[v]);
    sink.character('\n');
  }
  section(sink, "EndDriftmeshPointMarkers");
}

}  // namespace

void write_msh(const Mesh& mesh, const std::string& path) {
  (void)narrow<std::int32_t>(mesh.edges.size() + mesh.triangles.size(), "elements of a .msh file");
  FileSink sink(path);
  const Classification classes(mesh);
  write_format(sink);
  write_physical_names(sink, classes);
  write_entities(sink, classes);
  write_nodes(sink, mesh, classes);
  write_elements(sink, mesh, classes);
  for (std::int32_t k = 0; k < mesh.attributes_per_point; ++k) write_attribute(sink, mesh, k);
  if (!mesh.subdomains.empty()) write_triangle_data(sink, mesh, kSubdomainView, mesh.subdomains);
  if (!mesh.ranks.empty()) write_triangle_data(sink, mesh, kRankView, mesh.ranks);
  if (!mesh.point_markers.empty()) write_point_markers(sink, mesh.point_markers);
  sink.commit();
}

}  // namespace driftmesh
