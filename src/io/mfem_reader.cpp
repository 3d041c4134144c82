#include <algorithm>
#include <utility>
#include <vector>

#include "io/mfem_format.hpp"
#include "io/read_checks.hpp"
#include "io/word_cursor.hpp"

namespace driftmesh {
namespace {

class MfemParser {
 public:
  MfemParser(const std::string& file, std::string_view text) : file_(file), words_(file, text) {}

  Mesh parse() {
    if (words_.word() != "MFEM" || words_.word() != "mesh" || !words_.word().starts_with("v1."))
      words_.fail("does not begin with 'MFEM mesh v1.0'", "other versions, as of NURBS, are not read");
    expect("dimension");
    if (words_.number<std::int32_t>("a dimension") != 2) words_.fail("is not planar", kTrianglesOnly);
    read_elements();
    read_boundary();
    read_points();
    if (words_.peek() == "nodes") words_.fail("has curved elements", kTrianglesOnly);
    take_attributes();
    check_read_mesh(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  void expect(std::string_view section) {
    if (const std::string_view word = words_.word(); word != section)
      words_.fail("has '" + std::string(word.substr(0, 30)) + "' where '" + std::string(section) + "' is expected");
  }

  /// The attribute of the next element.
  std::int32_t take_head(std::int32_t geometry) {
    const auto attribute = words_.number<std::int32_t>("an attribute");
    if (const auto type = words_.number<std::int32_t>("a geometry type"); type != geometry)
      words_.fail("has an element of geometry type " + std::to_string(type), kTrianglesOnly);
    return attribute;
  }
  std::int32_t take_point() { return words_.number<std::int32_t>("a point of an element"); }

  void read_elements() {
    expect("elements");
    for (std::size_t left = words_.count("elements"); left > 0; --left) {
      region_tags_.push_back(take_head(kMfemTriangle));
      const std::int32_t a = take_point(), b = take_point(), c = take_point();
      mesh_.triangles.push_back({a, b, c});
    }
  }

  void read_boundary() {
    expect("boundary");
    for (std::size_t left = words_.count("edges"); left > 0; --left) {
      const std::int32_t tag = take_head(kMfemSegment);
      const std::int32_t a = take_point(), b = take_point();
      mesh_.edges.push_back({a, b, tag});
    }
  }

  void read_points() {
    expect("vertices");
    const std::size_t count = words_.count("points");
    if (count == 0) return;
    if (words_.peek() == "nodes") words_.fail("has curved elements", kTrianglesOnly);
    if (words_.number<std::int32_t>("a dimension") != 2) words_.fail("is not planar", kTrianglesOnly);
    for (std::size_t v = 0; v < count; ++v) {
      const auto x = words_.number<double>("x"), y = words_.number<double>("y");
      mesh_.points.push_back({x, y});
    }
  }

  /// All attributes are 1 where there are no regions.
  void take_attributes() {
    const TagComments& comments = words_.comments();
    mesh_.names = comments.names;
    for (Mesh::Edge& edge : mesh_.edges) edge.marker = comments.marker_of(edge.marker);
    if (comments.regions.empty() && std::ranges::all_of(region_tags_, [](std::int32_t tag) { return tag == 1; }))
      return;
    for (const std::int32_t tag : region_tags_) mesh_.regions.push_back(comments.region_of(tag));
  }

  const std::string& file_;
  WordCursor words_;
  std::vector<std::int32_t> region_tags_;
  Mesh mesh_;
};

}  // namespace

Mesh parse_mfem(const std::string& file, std::string_view text) {
  return MfemParser(file, text).parse();
}

}  // namespace driftmesh
