#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "io/msh_format.hpp"
#include "io/msh_groups.hpp"
#include "io/msh_parser.hpp"
#include "io/read_checks.hpp"
#include "io/tag_order.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

// Turns tags into indices and physical groups into markers and regions.
class MshAssembler {
 public:
  MshAssembler(const std::string& path, RawMsh&& raw)
      : path_(path),
        raw_(std::move(raw)),
        node_order_(order_by_tag(raw_.node_tags)),
        node_index_(ascending_node_tags()),
        line_order_(order_by_tag(raw_.lines.tags)),
        triangle_order_(order_by_tag(raw_.triangles.tags)) {}

  Mesh assemble() {
    require_distinct_elements();
    place_points();
    place_edges();
    place_triangles();
    mesh_.subdomains = values_of_triangles(raw_.subdomains, kSubdomainView);
    mesh_.ranks = values_of_triangles(raw_.ranks, kRankView);
    place_attributes();
    place_point_markers();
    place_names();
    mesh_.coordinates = raw_.coordinates;
    return std::move(mesh_);
  }

  /// Views of which some triangle has no value, or two, are left out.
  [[nodiscard]] TriangleData triangle_data() const {
    const TagIndex triangles = index_of_triangles();
    TriangleData data;
    for (const RawMsh::ElementView& view : raw_.views) {
      std::vector<double> values(triangle_order_.size());
      std::vector<bool> has_value(values.size(), false);
      std::size_t count = 0;
      bool twice = false;
      for (const RawMsh::AtElement<double>& v : view.values) {
        const std::int32_t t = triangles.find(static_cast<std::uint64_t>(v.element));
        if (t < 0) continue;
        twice = twice || has_value[t];
        has_value[t] = true;
        values[t] = v.value;
        ++count;
      }
      if (!twice && count == values.size()) data.emplace(view.name, std::move(values));
    }
    return data;
  }

 private:
  std::vector<std::uint64_t> ascending_node_tags() const {
    (void)narrow<std::int32_t>(raw_.node_tags.size(), "nodes");
    std::vector<std::uint64_t> tags;
    tags.reserve(node_order_.size());
    for (std::size_t i : node_order_) tags.push_back(raw_.node_tags[i]);
    const auto twice = std::adjacent_find(tags.begin(), tags.end());
    if (twice != tags.end()) fail("has two nodes of tag " + std::to_string(*twice));
    return tags;
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError({path_, 0}, what, kDamaged); }

  /// The order of the mesh, and values on elements, are by their tags.
  void require_distinct_elements() const {
    const std::vector<std::uint64_t>&lines = raw_.lines.tags, &triangles = raw_.triangles.tags;
    std::uint64_t last = 0;
    for (std::size_t i = 0, j = 0; i + j < lines.size() + triangles.size();) {
      const bool is_line =
          j == triangles.size() || (i < lines.size() && lines[line_order_[i]] <= triangles[triangle_order_[j]]);
      const std::uint64_t tag = is_line ? lines[line_order_[i]] : triangles[triangle_order_[j]];
      if (i + j > 0 && tag == last) fail("has two elements of tag " + std::to_string(tag));
      last = tag;
      ++(is_line ? i : j);
    }
  }

  [[nodiscard]] std::int32_t node(std::uint64_t tag, const char* user) const {
    const std::int32_t index = node_index_.find(tag);
    if (index < 0)
      throw InputError({path_, 0}, std::string(user) + " names node " + std::to_string(tag) + ", which does not exist",
                       kDamaged);
    return index;
  }

  void place_points() {
    mesh_.points.reserve(node_order_.size());
    for (std::size_t i : node_order_) mesh_.points.push_back(raw_.nodes[i]);
  }

  void place_edges() {
    const auto markers = values_of_entities<std::int32_t>(1, raw_.lines.entities, marker_of_group_name);
    mesh_.edges.reserve(raw_.lines.tags.size());
    for (std::size_t i : line_order_) {
      const auto& [a, b] = raw_.lines.nodes[i];
      mesh_.edges.push_back({node(a, "a line"), node(b, "a line"), markers.at(raw_.lines.entities[i])});
    }
  }

  void place_triangles() {
    const auto regions = values_of_entities<double>(2, raw_.triangles.entities, region_of_group_name);
    const bool has_regions = this->has_regions();
    mesh_.triangles.reserve(raw_.triangles.tags.size());
    for (std::size_t i : triangle_order_) {
      const auto& [a, b, c] = raw_.triangles.nodes[i];
      mesh_.triangles.push_back({node(a, "a triangle"), node(b, "a triangle"), node(c, "a triangle")});
      if (has_regions) mesh_.regions.push_back(regions.at(raw_.triangles.entities[i]));
    }
  }

  [[nodiscard]] TagIndex index_of_triangles() const {
    std::vector<std::uint64_t> tags;
    tags.reserve(triangle_order_.size());
    for (const std::size_t i : triangle_order_) tags.push_back(raw_.triangles.tags[i]);
    return TagIndex(std::move(tags));
  }

  /// Each triangle must have one; those of other elements are skipped.
  [[nodiscard]] std::vector<std::int32_t> values_of_triangles(
      const std::vector<RawMsh::AtElement<std::int32_t>>& values, std::string_view name) const {
    if (values.empty()) return {};
    const std::string view = "its view '" + std::string(name) + "'";
    const TagIndex triangles = index_of_triangles();
    std::set<std::uint64_t> others;
    std::vector<std::int32_t> result(triangle_order_.size(), -1);
    for (const RawMsh::AtElement<std::int32_t>& v : values) {
      const auto tag = static_cast<std::uint64_t>(v.element);
      const std::int32_t found = triangles.find(tag);
      const bool is_new = found < 0 ? others.insert(tag).second : std::exchange(result[found], v.value) < 0;
      if (!is_new) fail("has two values in " + view + " for element " + std::to_string(tag));
    }
    for (const auto* const tags_of_others : {&raw_.lines.tags, &raw_.point_elements})
      for (const std::uint64_t tag : *tags_of_others) others.erase(tag);
    if (!others.empty())
      fail("has a value in " + view + " for element " + std::to_string(*others.begin()) + ", which does not exist");
    if (std::find(result.begin(), result.end(), -1) != result.end())
      fail("has no value in " + view + " for some of its triangles");
    return result;
  }

  // The marker or region of each entity that is used: from the name of its group, otherwise the group's tag.
  template <class Value, class Parse>
  std::map<std::int32_t, Value> values_of_entities(std::int32_t dimension, const std::vector<std::int32_t>& used,
                                                   Parse parse) const {
    std::map<std::int32_t, Value> values;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (i > 0 && used[i] == used[i - 1]) continue;
      const auto group = raw_.entity_group.find({dimension, used[i]});
      if (group == raw_.entity_group.end()) {
        values[used[i]] = 0;
        continue;
      }
      values[used[i]] = value_of_group({dimension, group->second}, parse);
    }
    return values;
  }

  template <class Parse>
  [[nodiscard]] auto value_of_group(const RawMsh::EntityKey& group, Parse parse) const {
    using Value = typename decltype(parse({}))::value_type;
    if (const auto value = raw_.group_values.find(group); value != raw_.group_values.end())
      return static_cast<Value>(value->second);
    const auto name = raw_.group_names.find(group);
    const std::optional<Value> named = name == raw_.group_names.end() ? std::nullopt : parse(name->second);
    return named ? *named : static_cast<Value>(group.second);
  }

  /// Names of groups that stand for no number.
  void place_names() {
    for (const auto& [group, name] : raw_.group_names)
      if (group.first == 1)
        add_marker_name(mesh_.names, value_of_group(group, marker_of_group_name), name);
      else if (group.first == 2)
        add_region_name(mesh_.names, value_of_group(group, region_of_group_name), name);
  }

  // Not when no surface is in a group, nor when the only group is the one that write_msh gives a mesh without regions.
  [[nodiscard]] bool has_regions() const {
    for (const auto& [entity, group] : raw_.entity_group) {
      if (entity.first != 2) continue;
      const auto name = raw_.group_names.find({2, group});
      if (name == raw_.group_names.end() || name->second != kDomainName) return true;
    }
    return false;
  }

  void place_attributes() {
    std::erase_if(raw_.attributes, [&](const RawMsh::Attribute& attribute) {  // such as at nodes of lines alone
      return attribute.is_other && attribute.nodes.size() != mesh_.points.size();
    });
    const std::size_t per_point = raw_.attributes.size();
    mesh_.attributes_per_point = narrow<std::int32_t>(per_point, "attributes");
    mesh_.attributes.assign(per_point * mesh_.points.size(), 0);
    if (std::ranges::none_of(raw_.attributes, [](const auto& attribute) { return attribute.name.empty(); }))
      for (const RawMsh::Attribute& attribute : raw_.attributes) mesh_.attribute_names.push_back(attribute.name);
    for (std::size_t k = 0; k < per_point; ++k) {
      std::vector<bool> has_value(mesh_.points.size(), false);
      if (raw_.attributes[k].nodes.size() != mesh_.points.size())
        throw InputError({path_, 0},
                         "has attribute " + std::to_string(k + 1) + " at " +
                             std::to_string(raw_.attributes[k].nodes.size()) + " of " +
                             std::to_string(mesh_.points.size()) + " nodes",
                         kDamaged);
      for (std::size_t i = 0; i < raw_.attributes[k].nodes.size(); ++i) {
        const auto tag = static_cast<std::uint64_t>(raw_.attributes[k].nodes[i]);
        const auto v = node(tag, "$NodeData");
        if (has_value[v])
          fail("has two values of attribute " + std::to_string(k + 1) + " at node " + std::to_string(tag));
        has_value[v] = true;
        mesh_.attributes[v * per_point + k] = raw_.attributes[k].values[i];
      }
    }
  }

  void place_point_markers() {
    if (!raw_.point_markers) return;
    mesh_.point_markers.assign(mesh_.points.size(), 0);
    std::vector<bool> has_marker(mesh_.points.size(), false);
    for (const RawMsh::Marker& marker : *raw_.point_markers) {
      const auto v = node(marker.node, "a point marker");
      if (has_marker[v]) fail("has two point markers of node " + std::to_string(marker.node));
      has_marker[v] = true;
      mesh_.point_markers[v] = marker.marker;
    }
  }

  const std::string& path_;
  RawMsh raw_;
  std::vector<std::size_t> node_order_;
  TagIndex node_index_;
  std::vector<std::size_t> line_order_;
  std::vector<std::size_t> triangle_order_;
  Mesh mesh_;
};

}  // namespace

Mesh parse_msh(const std::string& file, std::string_view bytes) {
  Mesh mesh = MshAssembler(file, parse_msh_sections(file, bytes)).assemble();
  check_read_mesh(mesh, file);
  return mesh;
}

Mesh parse_msh(const std::string& file, std::string_view bytes, TriangleData& data) {
  MshAssembler assembler(file, parse_msh_sections(file, bytes, true));
  Mesh mesh = assembler.assemble();
  check_read_mesh(mesh, file);
  data = assembler.triangle_data();
  return mesh;
}

}  // namespace driftmesh
