#include "pslg/triangle_files.hpp"

#include <utility>

#include "base/read_file.hpp"
#include "pslg/record_scanner.hpp"

namespace driftmesh {
namespace {

constexpr std::int32_t kMaxAttributes = 1000;

struct NodeHeader {
  std::int32_t count = 0;
  std::int32_t attributes = 0;
  bool has_markers = false;
};

NodeHeader scan_node_header(RecordScanner& scanner) {
  scanner.require_record("the number of vertices", "the file has no data");
  NodeHeader header;
  header.count = scanner.header("the number of vertices");
  if (scanner.has_field() && scanner.header("the dimension") != 2)
    scanner.fail("the dimension is not 2", "only two-dimensional input can be meshed");
  header.attributes = scanner.optional_header("the number of attributes", kMaxAttributes);
  header.has_markers = scanner.optional_header("the number of boundary markers", 1) == 1;
  scanner.require_room(header.count, "vertices", 3 + header.attributes + (header.has_markers ? 1 : 0));
  return header;
}

void scan_attributes(RecordScanner& scanner, std::int32_t count, std::vector<double>& out) {
  for (std::int32_t i = 0; i < count; ++i) out.push_back(scanner.number("an attribute"));
}

}  // namespace

void RowNumbers::scan(RecordScanner& scanner, std::int32_t index) {
  const std::int32_t number = scanner.integer(field_.c_str());
  if (scanner.broken()) return;
  if (index == 0) {
    first_ = number;
    if (number != 0 && number != 1)
      scanner.fail("the first " + word_ + " has number " + std::to_string(number),
                   "number " + plural_ + " from 0 or from 1");
  }
  const std::int64_t expected = std::int64_t{index} + first_;
  if (number == expected) return;
  const bool repeated = number >= first_ && number < expected;
  scanner.problem(word_ + " number " + std::to_string(number) + (repeated ? " appears twice" : " is out of order"),
                  plural_ + " are numbered consecutively and " + std::to_string(expected) + " is next");
}

NodeTable scan_nodes(RecordScanner& scanner) {
  const NodeHeader header = scan_node_header(scanner);
  const std::size_t count = header.count;
  NodeTable nodes;
  nodes.attributes_per_point = header.attributes;
  nodes.points.reserve(count);
  nodes.attributes.reserve(count * header.attributes);
  if (header.has_markers) nodes.markers.reserve(count);
  RowNumbers numbers("vertex", "vertices");
  for (std::int32_t i = 0; i < header.count; ++i) {
    scanner.require_element(i, header.count, "vertices");
    numbers.scan(scanner, i);
    nodes.points.push_back(scanner.point());
    scan_attributes(scanner, header.attributes, nodes.attributes);
    if (header.has_markers) nodes.markers.push_back(scanner.integer("the boundary marker"));
  }
  nodes.first_number = numbers.first();
  return nodes;
}

std::int32_t scan_vertex(RecordScanner& scanner, std::size_t point_count, std::int32_t first_number) {
  const std::int32_t number = scanner.integer("a vertex number");
  const std::int64_t index = std::int64_t{number} - first_number;
  if (scanner.broken() || (index >= 0 && index < static_cast<std::int64_t>(point_count)))
    return static_cast<std::int32_t>(index);
  const std::int64_t last = static_cast<std::int64_t>(point_count) - 1 + first_number;
  scanner.problem("vertex " + std::to_string(number) + " does not exist",
                  "vertices are numbered " + std::to_string(first_number) + " to " + std::to_string(last));
  return 0;
}

NodeTable parse_node(const std::string& file, std::string_view text) {
  RecordScanner scanner(file, text);
  NodeTable nodes = scan_nodes(scanner);
  scanner.require_end();
  scanner.throw_problems();
  return nodes;
}

EleTable parse_ele(const std::string& file, std::string_view text, const NodeTable& nodes) {
  RecordScanner scanner(file, text);
  scanner.require_record("the number of triangles", "the file has no data");
  const std::int32_t count = scanner.header("the number of triangles");
  const std::int32_t corners = scanner.has_field() ? scanner.header("the number of nodes per triangle", 6) : 3;
  if (corners != 3 && corners != 6) scanner.fail("triangles have 3 or 6 nodes", "correct the second field");
  EleTable table;
  table.attributes_per_triangle = scanner.optional_header("the number of attributes", kMaxAttributes);
  scanner.require_room(count, "triangles", 1 + corners + table.attributes_per_triangle);
  table.triangles.reserve(count);
  RowNumbers numbers("triangle", "triangles");
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "triangles");
    numbers.scan(scanner, i);
    auto& triangle = table.triangles.emplace_back();
    for (auto& corner : triangle) corner = scan_vertex(scanner, nodes.points.size(), nodes.first_number);
    for (std::int32_t k = 3; k < corners; ++k) (void)scanner.integer("a midpoint number");
    scan_attributes(scanner, table.attributes_per_triangle, table.attributes);
  }
  scanner.require_end();
  scanner.throw_problems();
  return table;
}

std::vector<double> parse_area(const std::string& file, std::string_view text, std::size_t triangle_count) {
  RecordScanner scanner(file, text);
  scanner.require_record("the number of triangles", "the file has no data");
  const std::int32_t count = scanner.header("the number of triangles");
  if (std::cmp_not_equal(count, triangle_count))
    scanner.fail("has area bounds for " + std::to_string(count) + " triangles, but the mesh has " +
                     std::to_string(triangle_count),
                 "give the .area file that belongs to the mesh");
  std::vector<double> areas;
  areas.reserve(triangle_count);
  RowNumbers numbers("triangle", "triangles");
  for (std::int32_t i = 0; i < count; ++i) {
    scanner.require_element(i, count, "triangles");
    numbers.scan(scanner, i);
    areas.push_back(scanner.number("the area bound"));
  }
  scanner.require_end();
  scanner.throw_problems();
  return areas;
}

NodeTable read_node(const std::string& path) {
  return parse_node(path, read_file(path));
}

EleTable read_ele(const std::string& path, const NodeTable& nodes) {
  return parse_ele(path, read_file(path), nodes);
}

std::vector<double> read_area(const std::string& path, std::size_t triangle_count) {
  return parse_area(path, read_file(path), triangle_count);
}

}  // namespace driftmesh
