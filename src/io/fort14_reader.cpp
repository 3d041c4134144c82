#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/from_chars.hpp"
#include "io/boundary_types.hpp"
#include "io/byte_cursor.hpp"
#include "io/fort14_format.hpp"
#include "io/read_checks.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

/// The numbers of a line, one after the other. Whatever follows those that are asked for is a comment.
class Fields {
 public:
  Fields(SourcePlace place, std::string_view line) : place_(std::move(place)), line_(line) {}

  std::int32_t integer(const char* what) {
    const std::string_view word = next_word();
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail(word, what);
    return value;
  }

  /// Also as Fortran writes it: 1.5D+02.
  double real(const char* what) {
    const std::string_view word = next_word();
    std::string text(word);
    std::ranges::replace_if(
        text, [](char c) { return c == 'D' || c == 'd'; }, 'e');
    if (text.starts_with('+')) text.erase(0, 1);
    double value = 0;
    const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail(word, what);
    return value;
  }

  /// Whether another number follows, and no comment.
  [[nodiscard]] bool has_number() const {
    const std::size_t begin = line_.find_first_not_of(" \t,\r");
    return begin != std::string_view::npos &&
           std::string_view("+-.0123456789").find(line_[begin]) != std::string_view::npos;
  }

  [[noreturn]] void reject(const std::string& what, const char* next = kDamaged) const {
    throw InputError(place_, what, next);
  }

 private:
  std::string_view next_word() {
    const std::size_t begin = line_.find_first_not_of(" \t,");
    line_.remove_prefix(std::min(begin, line_.size()));
    const std::string_view word = line_.substr(0, line_.find_first_of(" \t,"));
    line_.remove_prefix(word.size());
    return word;
  }

  [[noreturn]] void fail(std::string_view word, const char* what) const {
    if (word.empty()) reject(std::string("lacks ") + what);
    reject("has '" + std::string(word) + "' in place of " + what);
  }

  SourcePlace place_;
  std::string_view line_;
};

class Fort14Parser {
 public:
  Fort14Parser(const std::string& file, std::string_view text) : file_(file), cursor_(file, text) {}

  Mesh parse() {
    read_title();
    Fields counts = next_line("the number of elements and nodes");
    const std::int32_t triangles = count(counts, "the number of elements"),
                       points = count(counts, "the number of nodes");
    for (std::int32_t v = 0; v < points; ++v) read_node(v);
    for (std::int32_t t = 0; t < triangles; ++t) read_triangle(t);
    read_open_boundaries();
    read_land_boundaries();
    if (std::ranges::all_of(mesh_.attributes, [](double depth) { return depth == 0; })) mesh_.attributes.clear();
    mesh_.attributes_per_point = mesh_.attributes.empty() ? 0 : 1;
    check_read_mesh(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  void read_title() {
    const std::string_view rest = cursor_.rest();
    next_line("the title");
    std::string_view title = rest.substr(0, rest.find('\n'));
    title = title.substr(0, title.find_last_not_of(" \t\r") + 1);
    const std::string_view begin(kFort14Title);
    if (!title.starts_with(begin) || title.size() < begin.size() + 2 || title[begin.size()] != ' ') return;
    title.remove_prefix(begin.size() + 1);
    if (fault_of_name(title).empty()) mesh_.coordinates = title;
  }

  Fields next_line(const char* what) {
    if (cursor_.remaining() == 0)
      throw InputError({file_, line_}, std::string("ends before ") + what, "it was not written completely");
    return {{file_, ++line_}, cursor_.take_line()};
  }
  /// The next line that is not blank, if there is one.
  bool at_end() {
    while (cursor_.remaining() > 0) {
      const std::string_view rest = cursor_.rest();
      const std::string_view line = rest.substr(0, rest.find('\n'));
      if (line.find_first_not_of(" \t\r") != std::string_view::npos) return false;
      cursor_.take_line();
      ++line_;
    }
    return true;
  }

  /// Each thing that is counted has a line of its own, of at least two characters.
  std::int32_t count(Fields& line, const char* what) {
    const std::int32_t n = line.integer(what);
    if (n < 0 || static_cast<std::size_t>(n) > cursor_.remaining() / 2 + 1)
      line.reject(std::string("has ") + std::to_string(n) + " as " + what + ", more than the file can hold");
    return n;
  }

  void read_node(std::int32_t v) {
    Fields line = next_line("all nodes are listed");
    if (line.integer("the number of a node") != v + 1)
      line.reject("is not node " + std::to_string(v + 1), "number nodes consecutively from 1");
    const double x = line.real("x"), y = line.real("y");
    mesh_.points.push_back({x, y});
    mesh_.attributes.push_back(line.real("the depth"));
  }

  void read_triangle(std::int32_t t) {
    Fields line = next_line("all elements are listed");
    if (line.integer("the number of an element") != t + 1)
      line.reject("is not element " + std::to_string(t + 1), "number elements consecutively from 1");
    if (const std::int32_t corners = line.integer("the number of nodes of an element"); corners != 3)
      line.reject("has an element of " + std::to_string(corners) + " nodes", "driftmesh reads meshes of triangles");
    std::array<std::int32_t, 3> triangle{};
    for (std::int32_t& corner : triangle) corner = vertex(line);
    mesh_.triangles.push_back(triangle);
  }

  std::int32_t vertex(Fields& line) {
    const std::int32_t v = line.integer("a node");
    if (v < 1 || static_cast<std::size_t>(v) > mesh_.points.size())
      line.reject("names node " + std::to_string(v) + ", but the nodes are 1 to " +
                  std::to_string(mesh_.points.size()));
    return v - 1;
  }

  /// A grid may end before its boundaries.
  void read_open_boundaries() {
    if (at_end()) return;
    Fields line = next_line("the number of open boundaries");
    const std::int32_t strings = count(line, "the number of open boundaries");
    next_line("the number of nodes on open boundaries");
    for (std::int32_t k = 0; k < strings; ++k) {
      Fields header = next_line("all open boundaries are listed");
      const std::int32_t nodes = count(header, "the number of nodes of an open boundary");
      add_string(read_nodes(nodes), kOpenType);
    }
  }

  void read_land_boundaries() {
    if (at_end()) return;
    Fields line = next_line("the number of land boundaries");
    const std::int32_t strings = count(line, "the number of land boundaries");
    next_line("the number of nodes on land boundaries");
    for (std::int32_t k = 0; k < strings; ++k) {
      Fields header = next_line("all land boundaries are listed");
      const std::int32_t nodes = count(header, "the number of nodes of a land boundary");
      const std::int32_t type = header.integer("the type of a land boundary");
      if (type < 0 || type > kLargestType)
        header.reject("has " + std::to_string(type) + " as the type of a boundary", "types are those of ADCIRC");
      if (const auto columns = weir_columns(type))
        read_weir(nodes, type, *columns);
      else
        read_land(nodes, type);
    }
  }

  void read_land(std::int32_t nodes, std::int32_t type) {
    std::vector<std::int32_t> string = read_nodes(nodes);
    if (is_closed_type(type) && string.size() > 2 && string.front() != string.back()) string.push_back(string.front());
    add_string(string, type);
  }

  void read_weir(std::int32_t nodes, std::int32_t type, WeirColumns columns) {
    Mesh::Weir weir{type, {}, {}, {}};
    bool is_bare = false;  // as in files for SCHISM, which reads the nodes alone
    for (std::int32_t k = 0; k < nodes; ++k) {
      Fields line = next_line("all nodes of a boundary are listed");
      weir.points.push_back(vertex(line));
      is_bare = is_bare || (k == 0 && !line.has_number());
      if (is_bare) continue;
      if (columns.has_pairs) weir.across.push_back(vertex(line));
      for (std::size_t i = 0; i < columns.numbers; ++i)
        weir.values.push_back(line.real("a height or a coefficient of a weir"));
    }
    if (weir.points.empty()) return;
    add_string(weir.points, type);
    add_string({weir.across.rbegin(), weir.across.rend()}, type);
    if (!is_bare) mesh_.weirs.push_back(std::move(weir));
  }

  std::vector<std::int32_t> read_nodes(std::int32_t nodes) {
    std::vector<std::int32_t> string;
    for (std::int32_t k = 0; k < nodes; ++k) {
      Fields line = next_line("all nodes of a boundary are listed");
      string.push_back(vertex(line));
    }
    return string;
  }

  void add_string(const std::vector<std::int32_t>& string, std::int32_t type) {
    if (string.empty()) return;
    const std::int32_t marker = marker_of(type, next_part(string, type));
    for (std::size_t i = 1; i < string.size(); ++i)
      if (const auto ends = std::minmax(string[i - 1], string[i]);
          ends.first != ends.second && listed_.emplace(ends.first, ends.second).second)
        mesh_.edges.push_back({string[i - 1], string[i], marker});
  }

  /// 0, unless a string of the same type ends where this one does: then the least that no such string is. Of land,
  /// nobody counts the strings.
  std::int32_t next_part(const std::vector<std::int32_t>& string, std::int32_t type) {
    if (type == kMainlandType || type == kIslandType) return 0;
    std::set<std::int32_t> taken;
    for (const std::int32_t end : {string.front(), string.back()})
      if (const auto known = parts_at_.find({type, end}); known != parts_at_.end())
        taken.merge(std::set(known->second));
    std::int32_t part = 0;
    while (taken.contains(part)) ++part;
    for (const std::int32_t end : {string.front(), string.back()}) parts_at_[{type, end}].insert(part);
    return part;
  }

  /// Gives the marker its name.
  std::int32_t marker_of(std::int32_t type, std::int32_t part) {
    if (type == kMainlandType) return kLandMarker;
    if (type == kIslandType) return kIslandMarker;
    const std::int32_t marker =
        (type == kOpenType && part == 0 ? kOpenMarker : kTypeMarkers + type) + part * kPartMarkers;
    mesh_.names.markers[marker] = name_of_type(type) + (part == 0 ? "" : " " + std::to_string(part + 1));
    return marker;
  }

  const std::string& file_;
  ByteCursor cursor_;
  std::size_t line_ = 0;
  Mesh mesh_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::set<std::int32_t>> parts_at_;  // by type and end of a string
  std::set<std::pair<std::int32_t, std::int32_t>> listed_;                            // edges: a weir may repeat one
};

}  // namespace

Mesh parse_fort14(const std::string& file, std::string_view text) {
  return Fort14Parser(file, text).parse();
}

}  // namespace driftmesh
