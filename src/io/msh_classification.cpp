#include "io/msh_classification.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "io/msh_groups.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

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

/// `names`: of markers or regions, which otherwise have the name that `number_name` makes.
template <class Value, class NumberName>
MshEntity make_entity(std::int32_t tag, Value value, const std::map<Value, std::string>& names,
                      const NumberName& number_name) {
  const auto name = names.find(value);
  if (name == names.end()) return {.tag = tag, .name = number_name(value), .box = {}};
  return {
      .tag = tag, .name = name->second, .box = {}, .value = static_cast<double>(value), .hides_value = tag != value};
}

}  // namespace

MshClassification::MshClassification(const Mesh& mesh) {
  classify_edges(mesh);
  classify_triangles(mesh);
  find_boxes(mesh);
  classify_nodes(mesh);
  find_boundaries(mesh);
}

void MshClassification::classify_edges(const Mesh& mesh) {
  DistinctValues markers;
  curve_of_edge.reserve(mesh.edges.size());
  for (const Mesh::Edge& edge : mesh.edges) curve_of_edge.push_back(markers.number(edge.marker));
  const std::vector<std::int32_t> tags = group_tags(markers.values);
  for (std::size_t i = 0; i < tags.size(); ++i)
    curves.push_back(
        make_entity(tags[i], static_cast<std::int32_t>(markers.values[i]), mesh.names.markers, marker_group_name));
}

void MshClassification::classify_triangles(const Mesh& mesh) {
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

void MshClassification::find_boxes(const Mesh& mesh) {
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    for (std::int32_t vertex : {mesh.edges[e].a, mesh.edges[e].b})
      curves[curve_of_edge[e]].box.extend(mesh.points[vertex]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::int32_t vertex : mesh.triangles[t]) surfaces[surface_of_triangle[t]].box.extend(mesh.points[vertex]);
}

void MshClassification::classify_nodes(const Mesh& mesh) {
  const auto first_surface = static_cast<std::int32_t>(curves.size());
  entity_of_node.assign(mesh.points.size(), first_surface);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::int32_t vertex : mesh.triangles[t]) entity_of_node[vertex] = first_surface + surface_of_triangle[t];
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    for (std::int32_t vertex : {mesh.edges[e].a, mesh.edges[e].b}) entity_of_node[vertex] = curve_of_edge[e];
}

void MshClassification::find_boundaries(const Mesh& mesh) {
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

}  // namespace driftmesh
