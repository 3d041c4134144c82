#include "mutants/declared_su2.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "mutants/declared_mesh.hpp"
#include "mutants/fields.hpp"

namespace driftmesh::mutants {
namespace {

using Words = std::vector<std::string>;

Words words_of(const std::string& line) {
  Words words;
  std::string word;
  for (const char c : line + " ")
    if (c != ' ' && c != '\t' && c != '\r')
      word += c;
    else if (!word.empty())
      words.push_back(std::exchange(word, ""));
  return words;
}

std::int64_t integer(const std::string& word, std::int64_t least = std::numeric_limits<std::int32_t>::min()) {
  const auto value = whole_number(word);
  if (!value || *value < least || *value > std::numeric_limits<std::int32_t>::max())
    throw Undeclared("no whole number");
  return *value;
}

double coordinate(const std::string& word) {
  const auto value = real_number(word);
  if (!value || !std::isfinite(*value)) throw Undeclared("no finite number");
  return *value;
}

/// A file as its sections: keywords, what stands behind '=', and the lines of words up to the next keyword.
struct Section {
  std::string keyword;
  Words value;
  std::vector<Words> lines;
};

class Su2File {
 public:
  explicit Su2File(std::string_view text) {
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) add(line);
  }

  Mesh mesh() {
    for (const Section& section : sections_) {
      const bool repeats = section.keyword == "MARKER_TAG" || section.keyword == "MARKER_ELEMS";
      if (!repeats && !seen_.insert(section.keyword).second) throw Undeclared("a keyword twice");
      read(section);
    }
    for (const char* const keyword : {"NDIME", "NELEM", "NPOIN"})
      if (!seen_.contains(keyword)) throw Undeclared("a keyword is missing");
    if (seen_.contains("NMARK") && announced_ != static_cast<std::int64_t>(tags_.size()))
      throw Undeclared("other markers");
    if (tags_.size() != edges_.size()) throw Undeclared("a marker without elements");
    mark();
    for (const auto& t : mesh_.triangles)
      for (const std::int32_t v : t) require_point(v);
    for (const auto& e : mesh_.edges) require_point(e.a), require_point(e.b);
    turn_if_seen_from_below(mesh_);
    return std::move(mesh_);
  }

 private:
  void add(const std::string& line) {
    constexpr std::string_view kName = "% driftmesh marker ";
    if (line.starts_with(kName)) {
      const Words words = words_of(line.substr(kName.size()));
      if (words.size() < 2) throw Undeclared("half a name");
      numbers_.emplace(words[1], integer(words[0]));
    }
    const std::string text = line.substr(0, line.find('%'));
    if (words_of(text).empty()) return;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      if (sections_.empty()) throw Undeclared("no keyword");
      return sections_.back().lines.push_back(words_of(text));
    }
    std::string keyword;  // with the blanks inside of it
    for (const std::string& word : words_of(text.substr(0, equals))) keyword += (keyword.empty() ? "" : " ") + word;
    sections_.push_back({keyword, words_of(text.substr(equals + 1)), {}});
  }

  void read(const Section& section) {
    const auto& [keyword, value, lines] = section;
    if (keyword.starts_with("MARKER_") && !seen_.contains("NMARK")) throw Undeclared("markers before their number");
    if (keyword == "SEND_TO" || keyword == "SEND_RECV") throw Undeclared("a part of a mesh");
    if (keyword == "NELEM" || keyword == "NPOIN" || keyword == "MARKER_ELEMS") {
      if (integer(first(value), 0) != static_cast<std::int64_t>(lines.size()))
        throw Undeclared("another number of lines");
    } else if (!lines.empty()) {
      throw Undeclared("lines that belong to nothing");
    }
    if ((keyword == "NDIME" && integer(first(value)) != 2) || (keyword == "NZONE" && integer(first(value)) != 1))
      throw Undeclared("not of two dimensions, or of many zones");
    if (keyword == "NMARK") announced_ = integer(first(value), 0);
    if (keyword == "MARKER_TAG") begin_marker(value);
    if (keyword == "MARKER_ELEMS") {
      if (tags_.size() != edges_.size() + 1) throw Undeclared("elements of no marker");
      edges_.push_back(elements<2>(lines, 3));
    }
    if (keyword == "NELEM") mesh_.triangles = elements<3>(lines, 5);
    if (keyword == "NPOIN")
      for (const Words& line : lines) {
        if (line.size() != 2 && line.size() != 3) throw Undeclared("no point");
        if (line.size() == 3) require_number(line[2]);
        mesh_.points.push_back({coordinate(line[0]), coordinate(line[1])});
      }
  }

  void begin_marker(const Words& value) {
    if (tags_.size() != edges_.size() || value.size() != 1 || value[0] == "SEND_RECEIVE") throw Undeclared("no marker");
    if (!names_.insert(value[0]).second) throw Undeclared("a marker twice");
    tags_.push_back(value[0]);
  }

  static const std::string& first(const Words& value) {
    if (value.empty()) throw Undeclared("no value");
    return value[0];
  }
  static void require_number(const std::string& word) {
    if (!whole_number(word)) throw Undeclared("no number of an element or a point");
  }
  void require_point(std::int32_t v) const {
    if (v < 0 || static_cast<std::size_t>(v) >= mesh_.points.size()) throw Undeclared("no such point");
  }

  template <std::size_t corners>
  static std::vector<std::array<std::int32_t, corners>> elements(const std::vector<Words>& lines, std::int64_t type) {
    std::vector<std::array<std::int32_t, corners>> all;
    for (const Words& line : lines) {
      if (line.size() != corners + 1 && line.size() != corners + 2) throw Undeclared("no element");
      if (integer(line[0]) != type) throw Undeclared("an element of another type");
      if (line.size() == corners + 2) require_number(line[corners + 1]);
      auto& element = all.emplace_back();
      for (std::size_t i = 0; i < corners; ++i) element[i] = static_cast<std::int32_t>(integer(line[i + 1]));
    }
    return all;
  }

  void mark() {
    std::vector<std::int64_t> markers(tags_.size(), 0);
    std::set<std::int64_t> used;
    std::set<std::size_t> unnumbered;
    for (std::size_t k = 0; k < tags_.size(); ++k) {
      const auto known = numbers_.find(tags_[k]);
      const auto number = whole_number(tags_[k]);
      const bool is_marker = number && *number >= std::numeric_limits<std::int32_t>::min() &&
                             *number <= std::numeric_limits<std::int32_t>::max() && !tags_[k].starts_with('+');
      if (known == numbers_.end() && !is_marker) {
        unnumbered.insert(k);
        continue;
      }
      markers[k] = known != numbers_.end() ? known->second : *number;
      if (!used.insert(markers[k]).second) throw Undeclared("two markers of one number");
    }
    for (const std::size_t k : unnumbered)
      for (markers[k] = 1; !used.insert(markers[k]).second;) ++markers[k];
    for (std::size_t k = 0; k < tags_.size(); ++k)
      for (const auto& [a, b] : edges_[k]) mesh_.edges.push_back({a, b, static_cast<std::int32_t>(markers[k])});
  }

  std::vector<Section> sections_;
  std::set<std::string> seen_, names_;
  std::map<std::string, std::int64_t> numbers_;  // numbers that comments give
  std::int64_t announced_ = 0;
  Words tags_;
  std::vector<std::vector<std::array<std::int32_t, 2>>> edges_;  // one list for each tag
  Mesh mesh_;
};

}  // namespace

Mesh declared_su2(std::string_view text) {
  return Su2File(text).mesh();
}

}  // namespace driftmesh::mutants
