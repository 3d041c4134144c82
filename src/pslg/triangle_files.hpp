#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

class RecordScanner;

/// A .node file of Triangle.
struct NodeTable {
  std::vector<Point> points;
  std::vector<std::int32_t> markers;  ///< empty, or one for each point
  std::vector<double> attributes;     ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;
  std::int32_t first_number = 1;  ///< the number of points[0] in the file: 0 or 1
};

/// An .ele file of Triangle.
struct EleTable {
  std::vector<std::array<std::int32_t, 3>>
      triangles;                   ///< corners as indices from 0; midpoints of 6-node elements dropped
  std::vector<double> attributes;  ///< attributes_per_triangle values for each triangle
  std::int32_t attributes_per_triangle = 0;
};

// All readers accept '#' comments, any blanks and CRLF. They throw FileError if a file cannot be read, and InputError
// with up to ten messages "file:line: what; next step" if its content is wrong, which includes fields or records that
// are missing or surplus, except for surplus fields that are 0. The first line has number 0 or 1; the others follow
// consecutively.

[[nodiscard]] NodeTable read_node(const std::string& path);
[[nodiscard]] NodeTable parse_node(const std::string& file, std::string_view text);

/// Corner numbers are checked against the nodes that they refer to.
[[nodiscard]] EleTable read_ele(const std::string& path, const NodeTable& nodes);
[[nodiscard]] EleTable parse_ele(const std::string& file, std::string_view text, const NodeTable& nodes);

/// An .area file: the area bound of each of `triangle_count` triangles; a negative value means no bound.
[[nodiscard]] std::vector<double> read_area(const std::string& path, std::size_t triangle_count);
[[nodiscard]] std::vector<double> parse_area(const std::string& file, std::string_view text,
                                             std::size_t triangle_count);

/// The marker of separators, on which subdomains meet, in the .poly and .edge of a mesh. They are constraints of the
/// mesh, but not of the domain.
inline constexpr std::int32_t kSeparatorMarker = -1'000'000;

// Parts that the readers of .poly and .edge share.

/// The numbers at the starts of the lines of a table: consecutive, from 0 or from 1.
class RowNumbers {
 public:
  /// What is numbered, for messages.
  RowNumbers(const std::string& word, std::string plural)
      : word_(word), plural_(std::move(plural)), field_("the " + word + " number") {}
  /// The first field of line `index`. Another number is a problem, and another first number the last one.
  void scan(RecordScanner& scanner, std::int32_t index);
  /// That of the first line: 0 or 1. 1 if there is none.
  [[nodiscard]] std::int32_t first() const { return first_; }

 private:
  std::string word_, plural_, field_;
  std::int32_t first_ = 1;
};

/// Reads the node section at the beginning of .node and .poly files; `scanner` has not read anything yet. Problems stay
/// in the scanner.
[[nodiscard]] NodeTable scan_nodes(RecordScanner& scanner);
/// A field that names a vertex, as an index from 0.
[[nodiscard]] std::int32_t scan_vertex(RecordScanner& scanner, std::size_t point_count, std::int32_t first_number);

}  // namespace driftmesh
