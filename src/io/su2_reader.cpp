#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "io/byte_cursor.hpp"
#include "io/number_of_word.hpp"
#include "io/read_checks.hpp"
#include "io/su2_format.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Removes the first word of a text.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

class Su2Parser {
 public:
  Su2Parser(const std::string& file, std::string_view text) : file_(file), cursor_(file, text) {}

  Mesh parse() {
    while (next_line()) parse_section();
    for (const char* keyword : {"NDIME", "NELEM", "NPOIN"})
      if (!seen_.contains(keyword)) throw InputError({file_, 0}, std::string("has no ") + keyword, kDamaged);
    if (seen_.contains("NMARK") && markers_ != tags_.size())
      throw InputError({file_, 0},
                       "announces " + std::to_string(markers_) + " markers, but has " + std::to_string(tags_.size()),
                       kDamaged);
    number_markers();
    check_read_mesh(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  /// Edges of one marker: mesh_.edges from `first` on, up to those of the next one.
  struct Tag {
    std::string word;
    std::size_t first = 0;
  };

  /// The next line that has more than a comment.
  bool next_line() {
    while (cursor_.remaining() > 0) {
      const std::string_view line = cursor_.take_line();
      ++line_number_;
      if (line.starts_with(kSu2NameComment)) take_name(line.substr(kSu2NameComment.size()));
      if (line.starts_with(kSu2Coordinates))
        if (const std::string words(trimmed(line.substr(kSu2Coordinates.size()))); fault_of_name(words).empty())
          mesh_.coordinates = words;
      line_ = trimmed(line.substr(0, line.find('%')));
      if (!line_.empty()) return true;
    }
    return false;
  }

  /// "5 in_let in let"
  void take_name(std::string_view words) {
    const auto marker = marker_from(take_word(words));
    const std::string tag(take_word(words));
    if (!marker || tag.empty()) fail("names a marker in a comment that is not complete");
    numbers_.try_emplace(tag, *marker);
    add_marker_name(mesh_.names, *marker, std::string(trimmed(words)));
  }

  void parse_section() {
    const std::size_t equals = line_.find('=');
    if (equals == std::string_view::npos) fail("has '" + start_of_line() + "' where a keyword is expected");
    const std::string keyword(trimmed(line_.substr(0, equals)));
    line_ = trimmed(line_.substr(equals + 1));
    if (keyword.starts_with("MARKER_") && !seen_.contains("NMARK")) fail("has " + keyword + " before NMARK");
    if (keyword == "MARKER_TAG") return begin_marker();
    if (keyword == "MARKER_ELEMS") return parse_edges();
    if (keyword == "SEND_TO" || keyword == "SEND_RECV")
      fail("has a marker between ranks", "give the mesh before it was divided");
    if (!seen_.insert(keyword).second) fail("has " + keyword + " twice");
    if (keyword == "NDIME" && take<std::int32_t>("a dimension") != 2)
      fail("is not planar", "driftmesh reads meshes of two dimensions");
    if (keyword == "NZONE" && take<std::int32_t>("a number of zones") != 1)
      fail("has several zones", "give one file for each");
    if (keyword == "NELEM") parse_triangles();
    if (keyword == "NPOIN") parse_points();
    if (keyword == "NMARK") markers_ = take_count("markers");
    // Others, such as AOA, are settings of solvers.
  }

  /// Each thing that is counted has a line of at least two characters.
  std::size_t take_count(const char* what) {
    const auto count = take<std::int64_t>("a count");
    if (count < 0 || static_cast<std::uint64_t>(count) > cursor_.remaining() / 2 + 1)
      fail("announces " + std::to_string(count) + " " + what + ", more than the file can hold");
    return static_cast<std::size_t>(count);
  }

  void parse_triangles() {
    for (std::size_t left = take_count("elements"); left > 0; --left)
      mesh_.triangles.push_back(take_element<3>(kSu2Triangle, "triangles (5)"));
  }

  void parse_edges() {
    if (tags_.empty() || !std::exchange(awaits_edges_, false)) fail("has MARKER_ELEMS without a MARKER_TAG");
    for (std::size_t left = take_count("edges"); left > 0; --left) {
      const auto [a, b] = take_element<2>(kSu2Line, "lines (3)");
      mesh_.edges.push_back({a, b, 0});
    }
  }

  /// Its type, its points, and maybe its number, which SU2 does not use.
  template <std::size_t kCorners>
  std::array<std::int32_t, kCorners> take_element(std::int32_t expected, const char* words) {
    if (!next_line()) fail("ends before all elements are listed");
    if (const auto type = take<std::int32_t>("the type of an element"); type != expected)
      fail("has an element of type " + std::to_string(type) + " among " + words, "driftmesh reads meshes of triangles");
    std::array<std::int32_t, kCorners> points{};
    for (std::int32_t& point : points) point = take<std::int32_t>("a point of an element");
    take_number_and_end();
    return points;
  }

  void parse_points() {
    const std::size_t count = take_count("points");
    for (std::size_t v = 0; v < count; ++v) {
      if (!next_line()) fail("ends before all points are listed");
      const auto x = take<double>("x"), y = take<double>("y");
      mesh_.points.push_back({x, y});
      take_number_and_end();
    }
  }

  void take_number_and_end() {
    if (!line_.empty()) (void)take<std::int64_t>("a number");
    if (!line_.empty()) fail("has more on a line than belongs there: '" + start_of_line() + "'");
  }

  void begin_marker() {
    if (awaits_edges_) fail("has MARKER_TAG twice in a row, without MARKER_ELEMS");
    const std::string word(take_word(line_));
    if (word.empty() || !line_.empty()) fail("has a MARKER_TAG that is not one word");
    if (word == "SEND_RECEIVE") fail("has a marker between ranks", "give the mesh before it was divided");
    if (std::ranges::any_of(tags_, [&](const Tag& tag) { return tag.word == word; }))
      fail("has the marker " + word + " twice");
    tags_.push_back({word, mesh_.edges.size()});
    awaits_edges_ = true;
  }

  /// Numbers that the file has, then free ones in the order of the file.
  void number_markers() {
    if (awaits_edges_) fail("ends before the MARKER_ELEMS of its last marker");
    std::vector<std::optional<std::int32_t>> markers;
    std::set<std::int32_t> used;
    for (const Tag& tag : tags_) {
      const auto known = numbers_.find(tag.word);
      markers.push_back(known != numbers_.end() ? known->second : marker_from(tag.word));
      if (markers.back() && !used.insert(*markers.back()).second)
        fail("has two markers of number " + std::to_string(*markers.back()));
    }
    std::int32_t next = 1;
    for (std::size_t k = 0; k < tags_.size(); ++k) {
      if (!markers[k]) {
        while (!used.insert(next).second) ++next;
        markers[k] = next;
        add_marker_name(mesh_.names, next, tags_[k].word);
      }
      const std::size_t end = k + 1 < tags_.size() ? tags_[k + 1].first : mesh_.edges.size();
      for (std::size_t e = tags_[k].first; e < end; ++e) mesh_.edges[e].marker = *markers[k];
    }
  }

  template <class Number>
  Number take(const char* what) {
    const std::string_view word = take_word(line_);
    line_ = trimmed(line_);
    if (word.empty()) fail(std::string("lacks ") + what);
    const auto value = number_of<Number>(word);
    if (!value) fail("has '" + std::string(word.substr(0, 30)) + "' in place of " + what);
    return *value;
  }

  [[nodiscard]] std::string start_of_line() const { return std::string(line_.substr(0, 30)); }

  [[noreturn]] void fail(const std::string& what, const char* next = kDamaged) const {
    throw InputError({file_, line_number_}, what, next);
  }

  const std::string& file_;
  ByteCursor cursor_;
  std::string_view line_;  // what is left of the current one
  std::size_t line_number_ = 0;
  std::set<std::string> seen_;  // keywords
  std::size_t markers_ = 0;     // announced
  std::vector<Tag> tags_;
  bool awaits_edges_ = false;                    // the last tag has no edges yet
  std::map<std::string, std::int32_t> numbers_;  // the numbers that comments give to tags
  Mesh mesh_;
};

}  // namespace

Mesh parse_su2(const std::string& file, std::string_view text) {
  return Su2Parser(file, text).parse();
}

}  // namespace driftmesh
