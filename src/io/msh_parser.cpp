#include "io/msh_parser.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/msh_groups.hpp"
#include "io/msh_input.hpp"
#include "io/read_checks.hpp"
#include "io/triangle_data.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMaxAttributes = 1000;

class MshParser {
 public:
  MshParser(const std::string& path, std::string_view bytes, bool views) : cursor_(path, bytes), views_(views) {}

  RawMsh parse() {
    while (cursor_.remaining() > 0) {
      cursor_.skip_blanks();
      if (cursor_.remaining() == 0) break;
      if (!cursor_.rest().starts_with('$')) fail("has something between its sections", kDamaged);
      parse_section(std::string(take_title().substr(1)));
    }
    for (const char* name : {"MeshFormat", "Nodes", "Elements"})
      if (!seen_.contains(name)) fail("has no $" + std::string(name), "is this a .msh file, and complete?");
    return std::move(raw_);
  }

 private:
  void parse_section(const std::string& name) {
    bool is_known = true;
    if (name == "MeshFormat") {
      parse_format();
    } else {
      if (!seen_.contains("MeshFormat")) fail("does not begin with $MeshFormat", "is this a .msh file?");
      is_known = is_binary_ ? parse_body(name, BinaryMshInput(cursor_)) : parse_body(name, TextMshInput(cursor_));
    }
    seen_.insert(name);
    if (is_known)
      require_end_of(name);
    else
      skip_to_end_of(name);
  }

  /// Whether all of the section was read.
  template <class Input>
  bool parse_body(const std::string& name, Input input) {
    if ((name == "Nodes" || name == "Elements" || name == "Entities" || name == "PhysicalNames") &&
        seen_.contains(name))
      fail("has two sections $" + name, kDamaged);
    if (name == "NodeData") return parse_node_data(input);
    if (name == "ElementData") return parse_element_data(input);
    if (name == "PhysicalNames")
      parse_physical_names();
    else if (name == "Entities")
      parse_entities(input);
    else if (name == "Nodes")
      parse_nodes(input);
    else if (name == "Elements")
      parse_elements(input);
    else if (name == "DriftmeshPointMarkers")
      parse_point_markers();
    else if (name == "DriftmeshValues")
      parse_group_values();
    else if (name == "DriftmeshCoordinates")
      parse_coordinates();
    else
      return false;
    return true;
  }

  /// A line without blanks at its end.
  std::string_view take_title() {
    std::string_view line = cursor_.take_line();
    while (!line.empty() && ByteCursor::is_blank(line.back())) line.remove_suffix(1);
    return line;
  }

  /// Checks the end of a section that has been read by its counts.
  void require_end_of(const std::string& name) {
    cursor_.skip_blanks();
    const SourcePlace place = cursor_.place();
    if (take_title() != "$End" + name)
      throw InputError(place, "there is more in $" + name + " than its counts announce", kDamaged);
  }

  void skip_to_end_of(const std::string& name) {
    const std::string end = "$End" + name;
    while (true) {
      if (cursor_.remaining() == 0) fail("ends before " + end, kDamaged);
      if (take_title() == end) return;
    }
  }

  void parse_format() {
    TextMshInput input(cursor_);
    const double version = input.real();
    const std::int32_t form = input.integer();
    const std::uint64_t size_bytes = input.size();
    if (version != 4.1)
      fail("is not of format version 4.1", "convert it: gmsh FILE -0 -save_all -format msh41 -o NEW.msh");
    if (form != 0 && form != 1) fail("is neither ASCII (0) nor binary (1)", kDamaged);
    is_binary_ = form == 1;
    if (size_bytes != 8)
      fail("has sizes of " + std::to_string(size_bytes) + " bytes, not 8", "write it on a 64-bit system");
    (void)cursor_.take_line();
    if (is_binary_ && cursor_.take<std::int32_t>("$MeshFormat") != 1)
      fail("is in the other byte order", "convert it to ASCII first");
  }

  void parse_physical_names() {
    TextMshInput input(cursor_);
    for (std::uint64_t left = input.size(); left > 0; --left) {
      const std::int32_t dimension = input.integer();
      const std::int32_t tag = input.integer();
      const std::string_view rest = cursor_.take_line();
      const std::size_t begin = rest.find('"');
      const std::size_t end = rest.rfind('"');
      if (begin == std::string_view::npos || begin == end)
        fail("has a physical group without a name in quotes", kDamaged);
      if (!raw_.group_names.try_emplace({dimension, tag}, rest.substr(begin + 1, end - begin - 1)).second)
        fail("has two physical groups of dimension " + std::to_string(dimension) + " and tag " + std::to_string(tag),
             kDamaged);
    }
  }

  template <class Input>
  void parse_entities(Input& input) {
    std::uint64_t counts[4];
    for (std::uint64_t& count : counts) count = input.size();
    for (std::int32_t dimension = 0; dimension < 4; ++dimension)
      for (std::uint64_t left = counts[dimension]; left > 0; --left) parse_entity(input, dimension);
  }

  template <class Input>
  void parse_entity(Input& input, std::int32_t dimension) {
    const std::int32_t tag = input.integer();
    if (!entities_.insert({dimension, tag}).second)
      fail("has two entities of dimension " + std::to_string(dimension) + " and tag " + std::to_string(tag), kDamaged);
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) (void)input.real();
    const std::uint64_t groups = input.size();
    for (std::uint64_t i = 0; i < groups; ++i) {
      const std::int32_t group = input.integer();
      if (i == 0) raw_.entity_group[{dimension, tag}] = group;
    }
    if (dimension == 0) return;
    for (std::uint64_t left = input.size(); left > 0; --left) (void)input.integer();
  }

  template <class Input>
  void parse_nodes(Input& input) {
    const std::uint64_t blocks = input.size();
    const std::uint64_t announced = input.size();
    for (int i = 0; i < 2; ++i) (void)input.size();  // smallest and largest tag
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = input.integer();
      (void)input.integer();
      const bool is_parametric = input.integer() != 0;
      if (dimension < 0 || dimension > 3)
        fail("has nodes on an entity of dimension " + std::to_string(dimension), kDamaged);
      const std::uint64_t count = input.size();
      for (std::uint64_t i = 0; i < count; ++i) raw_.node_tags.push_back(input.size());
      for (std::uint64_t i = 0; i < count; ++i) parse_node(input, is_parametric ? dimension : 0);
    }
    require_count("nodes", raw_.nodes.size(), announced);
  }

  void require_count(const char* what, std::uint64_t actual, std::uint64_t announced) const {
    if (actual != announced)
      fail("announces " + std::to_string(announced) + " " + what + ", but its blocks have " + std::to_string(actual),
           kDamaged);
  }

  template <class Input>
  void parse_node(Input& input, std::int32_t parameters) {
    const double x = input.real();
    const double y = input.real();
    const double z = input.real();
    for (std::int32_t i = 0; i < parameters; ++i) (void)input.real();
    if (raw_.nodes.empty()) z_ = z;
    if (z != z_) fail("is not planar: its nodes differ in z", "only planar meshes can be read");
    raw_.nodes.push_back({x, y});
  }

  template <class Input>
  void parse_elements(Input& input) {
    const std::uint64_t blocks = input.size();
    const std::uint64_t announced = input.size();
    for (int i = 0; i < 2; ++i) (void)input.size();  // smallest and largest tag
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = input.integer();
      const std::int32_t entity = input.integer();
      const std::int32_t type = input.integer();
      const std::uint64_t count = input.size();
      require_entity(dimension, entity, type);
      switch (type) {
        case 1:
          parse_element_block(input, raw_.lines, entity, count);
          break;
        case 2:
          parse_element_block(input, raw_.triangles, entity, count);
          break;
        case 15:
          parse_point_elements(input, count);
          break;
        default:
          fail_element_type(type);
      }
    }
    require_count("elements", raw_.lines.tags.size() + raw_.triangles.tags.size() + raw_.point_elements.size(),
                  announced);
  }

  /// The marker or region of elements is that of their entity.
  void require_entity(std::int32_t dimension, std::int32_t entity, std::int32_t type) const {
    const std::int32_t expected = type == 15 ? 0 : type == 1 ? 1 : 2;
    if (dimension != expected && (type == 1 || type == 2 || type == 15))
      fail("has elements of Gmsh's type " + std::to_string(type) + " on an entity of dimension " +
               std::to_string(dimension),
           kDamaged);
    if (seen_.contains("Entities") && !entities_.contains({dimension, entity}))
      fail("has elements on entity " + std::to_string(entity) + " of dimension " + std::to_string(dimension) +
               ", which $Entities does not list",
           "the file is damaged; a mesh in partitions can be read after gmsh has joined them");
  }

  template <class Input, std::size_t kCorners>
  static void parse_element_block(Input& input, RawMsh::Elements<kCorners>& elements, std::int32_t entity,
                                  std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      elements.tags.push_back(input.size());
      auto& corners = elements.nodes.emplace_back();
      for (std::uint64_t& corner : corners) corner = input.size();
      elements.entities.push_back(entity);
    }
  }

  template <class Input>
  void parse_point_elements(Input& input, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      raw_.point_elements.push_back(input.size());
      (void)input.size();
    }
  }

  [[noreturn]] void fail_element_type(std::int32_t type) const {
    const bool is_second_order = type == 8 || type == 9;
    fail("has elements of Gmsh's type " + std::to_string(type) + ", neither triangles (2) nor lines (1)",
         is_second_order ? "save the mesh in first order" : "only triangle meshes can be read");
  }

  struct View {
    std::string_view name;
    std::vector<std::int32_t> integers;
  };
  View parse_view_header(const char* section) {
    TextMshInput text(cursor_);
    View view;
    for (std::uint64_t left = text.size(); left > 0; --left) {
      cursor_.skip_blanks();
      const std::string_view line = cursor_.take_line();
      if (view.name.empty()) view.name = line;
      if (cursor_.remaining() == 0) fail(std::string("ends within ") + section, kDamaged);
    }
    for (std::uint64_t left = text.size(); left > 0; --left) (void)text.real();
    for (std::uint64_t left = text.size(); left > 0; --left) view.integers.push_back(text.integer());
    (void)cursor_.take_line();
    return view;
  }

  /// How many values a view has that write_msh wrote.
  [[nodiscard]] std::int32_t count_of_values(const View& view) const {
    if (view.integers.size() < 3 || view.integers[1] != 1 || view.integers[2] < 0)
      fail("has a view " + std::string(view.name) + " with other than one component, or without a count", kDamaged);
    return view.integers[2];
  }

  // What a view that others can have is called, if it has one value each and none before it has the name.
  template <class Known>
  static std::optional<std::string> name_of_other(const View& view, const std::vector<Known>& before) {
    std::string name(view.name.size() < 2 ? view.name : view.name.substr(1, view.name.size() - 2));  // without quotes
    const bool is_known = std::ranges::any_of(before, [&](const Known& known) { return known.name == name; });
    if (is_known || view.integers.size() < 3 || view.integers[1] != 1 || view.integers[2] < 0) return std::nullopt;
    if (!fault_of_name(name).empty() || before.size() == kMaxAttributes) return std::nullopt;
    return name;
  }

  // A view of another program, if it has one value each.
  template <class Input>
  bool parse_other_node_data(const View& view, Input& input) {
    const std::optional<std::string> name = name_of_other(view, raw_.attributes);
    if (!name) return false;
    RawMsh::Attribute& attribute = raw_.attributes.emplace_back();
    attribute.name = *name;
    attribute.is_other = true;
    for (std::int32_t left = view.integers[2]; left > 0; --left) {
      attribute.nodes.push_back(input.integer());
      attribute.values.push_back(input.real());
    }
    return true;
  }

  // Whether it is an attribute; other views are not read.
  template <class Input>
  bool parse_node_data(Input& input) {
    const View view = parse_view_header("$NodeData");
    if (!view.name.starts_with("\"attribute ")) return parse_other_node_data(view, input);
    const auto own = std::ranges::count(raw_.attributes, false, &RawMsh::Attribute::is_other);
    const std::string begin = "\"attribute " + std::to_string(own + 1);
    const bool is_named = view.name.starts_with(begin + ": ") && view.name.ends_with('"');
    if (view.name != begin + '"' && !is_named)
      fail("has the view " + std::string(view.name) + " in place of " + begin + '"', kDamaged);
    if (raw_.attributes.size() == kMaxAttributes) fail("has more than 1000 attributes", kDamaged);
    RawMsh::Attribute& attribute = raw_.attributes.emplace_back();
    if (is_named) attribute.name = view.name.substr(begin.size() + 2, view.name.size() - begin.size() - 3);
    for (std::int32_t left = count_of_values(view); left > 0; --left) {
      attribute.nodes.push_back(input.integer());
      attribute.values.push_back(input.real());
    }
    return true;
  }

  // A view on elements, if it has one value each, and these are wanted.
  template <class Input>
  bool parse_element_view(const View& view, Input& input) {
    const std::optional<std::string> name = name_of_other(view, raw_.views);
    if (!views_ || !name || is_array_on_cells(*name)) return false;
    RawMsh::ElementView& read = raw_.views.emplace_back();
    read.name = *name;
    for (std::int32_t left = view.integers[2]; left > 0; --left) {
      const std::int32_t element = input.integer();
      read.values.push_back({element, input.real()});
    }
    return true;
  }

  // The same for subdomains and ranks.
  template <class Input>
  bool parse_element_data(Input& input) {
    const View view = parse_view_header("$ElementData");
    auto* const values = view.name == quoted(kSubdomainView) ? &raw_.subdomains
                         : view.name == quoted(kRankView)    ? &raw_.ranks
                                                             : nullptr;
    if (values == nullptr) return parse_element_view(view, input);
    for (std::int32_t left = count_of_values(view); left > 0; --left) {
      const std::int32_t element = input.integer();
      const double value = input.real();
      if (!(value >= 0 && value <= INT32_MAX && value == std::floor(value)))
        fail("has a " + std::string(view.name) + " that is not a whole number from 0 on", kDamaged);
      values->push_back({element, static_cast<std::int32_t>(value)});
    }
    return true;
  }
  static std::string quoted(std::string_view name) { return '"' + std::string(name) + '"'; }

  void parse_point_markers() {
    TextMshInput input(cursor_);
    raw_.point_markers.emplace();
    for (std::uint64_t left = input.size(); left > 0; --left) {
      const std::uint64_t node = input.size();
      raw_.point_markers->push_back({node, input.integer()});
    }
  }

  void parse_coordinates() {
    const std::string words(take_title());
    if (fault_of_name(words).empty()) raw_.coordinates = words;
  }

  void parse_group_values() {
    TextMshInput input(cursor_);
    for (std::uint64_t left = input.size(); left > 0; --left) {
      const std::int32_t dimension = input.integer();
      const std::int32_t tag = input.integer();
      const double value = input.real();
      if (!std::isfinite(value) || (dimension == 1 && value != static_cast<double>(static_cast<std::int32_t>(
                                                                   std::clamp<double>(value, INT32_MIN, INT32_MAX)))))
        fail("has a value in $DriftmeshValues that is no marker or region", kDamaged);
      if (!raw_.group_values.try_emplace({dimension, tag}, value).second)
        fail("has two values in $DriftmeshValues for dimension " + std::to_string(dimension) + " and tag " +
                 std::to_string(tag),
             kDamaged);
    }
  }

  [[noreturn]] void fail(const std::string& what, const std::string& next) const {
    throw InputError(cursor_.place(), what, next);
  }

  ByteCursor cursor_;
  bool views_;
  bool is_binary_ = false;
  double z_ = 0;
  std::set<std::string> seen_;
  std::set<RawMsh::EntityKey> entities_;
  RawMsh raw_;
};

}  // namespace

RawMsh parse_msh_sections(const std::string& path, std::string_view bytes, bool views) {
  return MshParser(path, bytes, views).parse();
}

}  // namespace driftmesh
