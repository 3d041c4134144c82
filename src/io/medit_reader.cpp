#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

#include "io/medit_format.hpp"
#include "io/read_checks.hpp"
#include "io/word_cursor.hpp"

namespace driftmesh {
namespace {

class MeditParser {
 public:
  MeditParser(const std::string& file, std::string_view text) : file_(file), words_(file, text) {}

  Mesh parse() {
    if (words_.word() != "MeshVersionFormatted") words_.fail("does not begin with MeshVersionFormatted");
    if (const auto version = words_.number<std::int32_t>("a version"); version < 0 || version > 4)
      words_.fail("has version " + std::to_string(version), "versions 0 to 4 are read");
    bool is_complete = false;
    while (!is_complete) is_complete = !read_section(std::string(words_.word()));
    if (dimension_ == 0) words_.fail("has no Dimension");
    take_references();
    check_read_mesh(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  /// Whether more sections follow.
  bool read_section(const std::string& section) {
    if (section == "End") return false;
    if (section.empty()) words_.fail("ends before End");
    if (std::isalpha(static_cast<unsigned char>(section.front())) == 0)
      words_.fail("has '" + section.substr(0, 30) + "' where a section is expected");
    if (!seen_.insert(section).second) words_.fail("has the section " + section + " twice");
    if (section == "Dimension")
      read_dimension();
    else if (section == "Vertices")
      read_points();
    else if (section == "Edges")
      read_edges();
    else if (section == "Triangles")
      read_triangles();
    else if (section == "Quadrilaterals" || section == "Tetrahedra" || section == "Hexahedra")
      refuse_elements(section);
    else
      skip_section();
    return true;
  }

  void read_dimension() {
    dimension_ = words_.number<std::int32_t>("a dimension");
    if (dimension_ != 2 && dimension_ != 3) words_.fail("has dimension " + std::to_string(dimension_), kTrianglesOnly);
  }

  void read_points() {
    if (dimension_ == 0) words_.fail("has Vertices before its Dimension");
    for (std::size_t left = words_.count("points"); left > 0; --left) {
      const auto x = words_.number<double>("x"), y = words_.number<double>("y");
      if (dimension_ == 3 && words_.number<double>("z") != 0) words_.fail("has a point off the plane", kTrianglesOnly);
      mesh_.points.push_back({x, y});
      mesh_.point_markers.push_back(words_.number<std::int32_t>("the reference of a point"));
    }
  }

  void read_edges() {
    for (std::size_t left = words_.count("edges"); left > 0; --left) {
      const std::int32_t a = take_point(), b = take_point();
      mesh_.edges.push_back({a, b, words_.number<std::int32_t>("the reference of an edge")});
    }
  }

  void read_triangles() {
    for (std::size_t left = words_.count("triangles"); left > 0; --left) {
      const std::int32_t a = take_point(), b = take_point(), c = take_point();
      mesh_.triangles.push_back({a, b, c});
      region_tags_.push_back(words_.number<std::int32_t>("the reference of a triangle"));
    }
  }

  /// Numbers begin at 1.
  std::int32_t take_point() {
    const auto number = words_.number<std::int32_t>("a number of a point");
    if (number < 1) words_.fail("names point " + std::to_string(number) + ", but numbers begin at 1");
    return number - 1;
  }

  void refuse_elements(const std::string& section) {
    if (words_.count("elements") > 0) words_.fail("has " + section, kTrianglesOnly);
  }

  void skip_section() {
    while (!words_.peek().empty() && std::isalpha(static_cast<unsigned char>(words_.peek().front())) == 0)
      (void)words_.word();
  }

  void take_references() {
    const TagComments& comments = words_.comments();
    mesh_.names = comments.names;
    for (Mesh::Edge& edge : mesh_.edges) edge.marker = comments.marker_of(edge.marker);
    if (std::ranges::all_of(mesh_.point_markers, [](std::int32_t m) { return m == 0; })) mesh_.point_markers.clear();
    if (std::ranges::all_of(region_tags_, [](std::int32_t tag) { return tag == 0; })) return;
    for (const std::int32_t tag : region_tags_) mesh_.regions.push_back(comments.region_of(tag));
  }

  const std::string& file_;
  WordCursor words_;
  std::set<std::string> seen_;  // sections
  std::int32_t dimension_ = 0;
  std::vector<std::int32_t> region_tags_;
  Mesh mesh_;
};

}  // namespace

Mesh parse_medit(const std::string& file, std::string_view text) {
  return MeditParser(file, text).parse();
}

}  // namespace driftmesh
