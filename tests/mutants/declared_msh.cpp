#include "mutants/declared_msh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mutants/declared_mesh.hpp"
#include "mutants/msh_text.hpp"

namespace driftmesh::mutants {
namespace {

class MshFile {
 public:
  MshFile(std::string_view bytes, Fields& fields) : in_(bytes, fields) {}

  Mesh mesh() {
    while (in_.skip_blanks(), !in_.at_end()) read_section();
    if (!seen_.contains("Nodes") || !seen_.contains("Elements")) throw Undeclared("a section is missing");
    place_points();
    place_elements();
    place_views();
    turn_if_seen_from_below(mesh_);
    return std::move(mesh_);
  }

 private:
  using Entity = std::pair<std::int32_t, std::int32_t>;  // dimension and tag
  struct Element {
    std::int32_t entity;
    std::vector<std::uint64_t> nodes;
  };

  void read_section() {
    const std::string_view line = in_.line();
    if (!line.starts_with('$')) throw Undeclared("something between the sections");
    const std::string name(line.substr(1));
    const bool may_repeat = name == "NodeData" || name == "ElementData";
    if (seen_.empty() != (name == "MeshFormat")) throw Undeclared("$MeshFormat must be first");
    const bool is_known = read_known(name);
    if (is_known && seen_.contains(name) && !may_repeat) throw Undeclared("a section twice");
    seen_.insert(name);
    if (is_known) {
      in_.skip_blanks();
      if (in_.line() != "$End" + name) throw Undeclared("a section is longer than announced");
    }
  }

  /// Otherwise it was skipped, with its end.
  bool read_known(const std::string& name) {
    if (name == "MeshFormat")
      read_format();
    else if (name == "PhysicalNames")
      read_groups();
    else if (name == "Entities")
      read_entities();
    else if (name == "Nodes")
      read_nodes();
    else if (name == "Elements")
      read_elements();
    else if (name == "DriftmeshPointMarkers")
      read_point_markers();
    else if (name == "NodeData" || name == "ElementData")
      return read_view(name);
    else
      return skip(name);
    return true;
  }

  bool skip(const std::string& name) {
    while (in_.line() != "$End" + name)
      if (in_.at_end()) throw Undeclared("a section without an end");
    return false;
  }

  void read_format() {
    if (in_.text_real() != 4.1) throw Undeclared("another version");
    const std::int32_t is_binary = in_.text_integer();
    if ((is_binary != 0 && is_binary != 1) || in_.text_integer() != 8) throw Undeclared("an unknown form");
    (void)in_.line();
    if (is_binary == 0) return;
    in_.is_binary = true;
    if (in_.integer() != 1) throw Undeclared("another byte order");
  }

  void read_groups() {
    for (std::uint64_t left = in_.text_count(); left > 0; --left) {
      const std::int32_t dimension = in_.text_integer(), tag = in_.text_integer();
      const std::string_view line = in_.line();
      const std::size_t begin = line.find('"'), end = line.rfind('"');
      if (begin == end) throw Undeclared("a group without a name");
      const std::string name(line.substr(begin + 1, end - begin - 1));
      if (!group_names_.emplace(Entity{dimension, tag}, name).second) throw Undeclared("a group twice");
    }
  }

  void read_entities() {
    std::uint64_t counts[4];
    for (std::uint64_t& count : counts) count = in_.count();
    in_.end_record();
    for (std::int32_t dimension = 0; dimension < 4; ++dimension)
      for (std::uint64_t left = counts[dimension]; left > 0; --left) {
        const std::int32_t tag = in_.integer();
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) (void)in_.real();
        std::vector<std::int32_t> groups(in_.count());
        for (std::int32_t& group : groups) group = in_.integer();
        if (dimension > 0)
          for (std::uint64_t borders = in_.count(); borders > 0; --borders) (void)in_.integer();
        in_.end_record();
        if (!entities_.emplace(Entity{dimension, tag}, groups).second) throw Undeclared("an entity twice");
      }
  }

  void read_nodes() {
    const std::uint64_t blocks = in_.count(), announced = in_.count();
    (void)in_.size(), (void)in_.size();
    in_.end_record();
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = in_.integer();
      (void)in_.integer();
      const bool is_parametric = in_.integer() != 0;
      std::vector<std::uint64_t> tags(in_.count());
      in_.end_record();
      if (dimension < 0 || dimension > 3) throw Undeclared("an entity of unknown dimension");
      for (std::uint64_t& tag : tags) tag = in_.size(), in_.end_record();
      for (const std::uint64_t tag : tags) read_node(tag, is_parametric ? dimension : 0);
    }
    if (points_.size() != announced) throw Undeclared("another number of nodes");
  }

  void read_node(std::uint64_t tag, std::int32_t parameters) {
    Point point;
    point.x = in_.real();
    point.y = in_.real();
    const double z = in_.real();
    for (std::int32_t i = 0; i < parameters; ++i) (void)in_.real();
    in_.end_record();
    if (points_.empty()) z_ = z;
    if (z != z_ || !std::isfinite(point.x) || !std::isfinite(point.y)) throw Undeclared("nodes in no plane");
    if (!points_.emplace(tag, point).second) throw Undeclared("a node twice");
  }

  void read_elements() {
    const std::uint64_t blocks = in_.count(), announced = in_.count();
    (void)in_.size(), (void)in_.size();
    in_.end_record();
    std::uint64_t number = 0;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = in_.integer(), entity = in_.integer(), type = in_.integer();
      const std::uint64_t count = in_.count();
      in_.end_record();
      if (type != 1 && type != 2 && type != 15) throw Undeclared("elements of another type");
      if (dimension != (type == 15 ? 0 : type)) throw Undeclared("elements of another dimension");
      if (seen_.contains("Entities") && !entities_.contains({dimension, entity})) throw Undeclared("no such entity");
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t tag = in_.size();
        Element element{entity, std::vector<std::uint64_t>(static_cast<std::size_t>(dimension) + 1)};
        for (std::uint64_t& node : element.nodes) node = in_.size();
        in_.end_record();
        element_tags_.insert(tag);
        if (type != 15 && !tags_in_mesh_.insert(tag).second) throw Undeclared("an element twice");
        if (type == 1) lines_.emplace(tag, element);
        if (type == 2) triangles_.emplace(tag, element);
      }
      number += count;
    }
    if (number != announced) throw Undeclared("another number of elements");
  }

  void read_point_markers() {
    for (std::uint64_t left = in_.text_count(); left > 0; --left) {
      const std::uint64_t node = in_.text_size();
      if (!point_markers_.emplace(node, in_.text_integer()).second) throw Undeclared("a marker twice");
    }
  }

  /// Attributes on nodes; subdomains and ranks on elements. Other views, and their values, are skipped.
  bool read_view(const std::string& section) {
    std::vector<std::string> texts;
    for (std::uint64_t left = in_.text_count(); left > 0; --left) {
      in_.skip_blanks();
      texts.emplace_back(in_.line());
    }
    for (std::uint64_t left = in_.text_count(); left > 0; --left) (void)in_.text_real();
    std::vector<std::int32_t> integers(in_.text_count());
    for (std::int32_t& integer : integers) integer = in_.text_integer();
    (void)in_.line();
    const std::string name = texts.empty() ? "" : texts[0];
    const bool is_ours =
        section == "NodeData" ? name.starts_with("\"attribute ") : name == "\"subdomain\"" || name == "\"rank\"";
    if (!is_ours) return skip(section);
    if (integers.size() < 3 || integers[1] != 1 || integers[2] < 0) throw Undeclared("a view of an unknown kind");
    auto& values = views_[name];
    for (std::int32_t left = integers[2]; left > 0; --left) {
      const std::int32_t tag = in_.integer();
      const double value = in_.real();
      in_.end_record();
      if (!values.emplace(tag, value).second) throw Undeclared("a value twice");
    }
    return true;
  }

  [[nodiscard]] std::int32_t index_of(std::uint64_t node) const {
    const auto found = index_.find(node);
    if (found == index_.end()) throw Undeclared("no such node");
    return found->second;
  }

  void place_points() {
    for (const auto& [tag, point] : points_) {
      index_.emplace(tag, static_cast<std::int32_t>(index_.size()));
      mesh_.points.push_back(point);
    }
    if (!seen_.contains("DriftmeshPointMarkers")) return;
    mesh_.point_markers.assign(mesh_.points.size(), 0);
    for (const auto& [tag, marker] : point_markers_)
      mesh_.point_markers[static_cast<std::size_t>(index_of(tag))] = marker;
  }

  /// From the name of the first group of an entity, as in "marker 5", or its tag; 0 without a group.
  [[nodiscard]] double value_of(const Entity& entity, const std::string& word) const {
    const auto found = entities_.find(entity);
    if (found == entities_.end() || found->second.empty()) return 0;
    const std::int32_t tag = found->second[0];
    const auto name = group_names_.find({entity.first, tag});
    if (name == group_names_.end() || !name->second.starts_with(word + " ")) return tag;
    const std::string value = name->second.substr(word.size() + 1);
    const std::optional<std::int64_t> integer = whole_number(value);
    const bool is_marker = integer && std::in_range<std::int32_t>(*integer) && value[0] != '+';
    if (word == "marker") return is_marker ? static_cast<double>(*integer) : tag;
    const std::optional<double> real = real_number(value);
    return real && value[0] != '+' ? *real : tag;
  }

  void place_elements() {
    for (const auto& [tag, line] : lines_)
      mesh_.edges.push_back({index_of(line.nodes[0]), index_of(line.nodes[1]),
                             static_cast<std::int32_t>(value_of({1, line.entity}, "marker"))});
    const bool has_regions = std::ranges::any_of(entities_, [&](const auto& entity) {
      if (entity.first.first != 2 || entity.second.empty()) return false;
      const auto name = group_names_.find({2, entity.second[0]});
      return name == group_names_.end() || name->second != "domain";
    });
    for (const auto& [tag, triangle] : triangles_) {
      mesh_.triangles.push_back(
          {index_of(triangle.nodes[0]), index_of(triangle.nodes[1]), index_of(triangle.nodes[2])});
      if (has_regions) mesh_.regions.push_back(value_of({2, triangle.entity}, "region"));
    }
  }

  void place_views() {
    std::size_t attributes = 0;
    for (const auto& [name, values] : views_)
      if (name.starts_with("\"attribute ")) ++attributes;
    mesh_.attributes_per_point = static_cast<std::int32_t>(attributes);
    mesh_.attributes.assign(attributes * mesh_.points.size(), 0);
    for (std::size_t k = 0; k < attributes; ++k) {
      const auto view = views_.find("\"attribute " + std::to_string(k + 1) + "\"");
      if (view == views_.end() || view->second.size() != mesh_.points.size())
        throw Undeclared("an attribute lacks values");
      for (const auto& [tag, value] : view->second)
        mesh_.attributes[static_cast<std::size_t>(index_of(static_cast<std::uint64_t>(tag))) * attributes + k] = value;
    }
    mesh_.subdomains = whole_numbers_of_triangles("\"subdomain\"");
    mesh_.ranks = whole_numbers_of_triangles("\"rank\"");
  }

  /// Values on lines do not matter.
  [[nodiscard]] std::vector<std::int32_t> whole_numbers_of_triangles(const std::string& name) const {
    const auto view = views_.find(name);
    if (view == views_.end() || view->second.empty()) return {};
    std::vector<std::int32_t> result;
    for (const auto& [tag, value] : view->second) {
      if (!element_tags_.contains(static_cast<std::uint64_t>(tag))) throw Undeclared("a value of no element");
      if (!(value >= 0 && value <= std::numeric_limits<std::int32_t>::max() && value == std::floor(value)))
        throw Undeclared("a value that is no number of a subdomain or rank");
    }
    for (const auto& [tag, triangle] : triangles_) {
      const auto found = view->second.find(static_cast<std::int32_t>(tag));
      if (tag > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()) || found == view->second.end())
        throw Undeclared("a triangle without a value");
      result.push_back(static_cast<std::int32_t>(found->second));
    }
    return result;
  }

  MshText in_;
  std::set<std::string> seen_;
  std::map<Entity, std::string> group_names_;
  std::map<Entity, std::vector<std::int32_t>> entities_;  // with their groups
  std::map<std::uint64_t, Point> points_;
  double z_ = 0;
  std::set<std::uint64_t> element_tags_, tags_in_mesh_;  // those of points are in the first
  std::map<std::uint64_t, Element> lines_, triangles_;
  std::map<std::uint64_t, std::int32_t> point_markers_;
  std::map<std::string, std::map<std::int32_t, double>> views_;
  std::map<std::uint64_t, std::int32_t> index_;
  Mesh mesh_;
};

/// The value of a binary field, in decimal digits that read back to the same.
std::string digits_of(const Field& field, std::string_view bytes) {
  const auto value = [&]<class T>(T number) {
    std::memcpy(&number, bytes.data() + field.begin, sizeof(T));
    return fmt::format("{}", number);
  };
  if (field.kind == Field::Kind::kInt32) return value(std::int32_t{});
  if (field.kind == Field::Kind::kInt64) return value(std::uint64_t{});
  return value(double{});
}

}  // namespace

Mesh declared_msh(std::string_view bytes, Fields& fields) {
  return MshFile(bytes, fields).mesh();
}

std::string msh_as_text(std::string_view binary) {
  Fields fields;
  (void)declared_msh(binary, fields);
  std::string text;
  std::size_t at = 0;
  bool was_number = false;
  for (const Field& field : fields) {
    if (field.kind == Field::Kind::kText) {
      text.append(was_number ? "\n" : binary.substr(at, field.begin - at))
          .append(binary.substr(field.begin, field.size));
      was_number = false;
    } else {
      if (!was_number) text += '\n';
      text += digits_of(field, binary) + (field.ends_record ? '\n' : ' ');
      was_number = true;
    }
    at = field.begin + field.size;
  }
  const std::string format = "4.1 1 8\n1 ";  // the 1 shows the byte order
  const std::size_t found = text.find(format);
  if (found == std::string::npos) throw Undeclared("no binary file");
  return text.replace(found, format.size(), "4.1 0 8\n") + "\n";
}

}  // namespace driftmesh::mutants
