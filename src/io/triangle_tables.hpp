#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driftmesh/point.hpp"
#include "io/file_sink.hpp"

namespace driftmesh {

// The tables of Triangle's files: a header, then a line for each entry. Indices start at 0; `first`, 0 or 1, is the
// number of the first entry in the file.

/// A .node file, or the beginning of a .poly.
struct NodeLines {
  std::span<const Point> points;
  std::span<const double> attributes;  ///< attributes_per_point for each point
  std::size_t attributes_per_point = 0;
  std::span<const std::int32_t> markers;  ///< empty, or one for each point
};
void write_nodes(FileSink& sink, const NodeLines& nodes, std::int32_t first);

/// An .ele file.
struct ElementLines {
  std::span<const std::int32_t> points;  ///< points_per_element for each element
  std::size_t points_per_element = 3;
  std::span<const double> attributes;  ///< attributes_per_element for each element
  std::size_t attributes_per_element = 0;
};
void write_elements(FileSink& sink, const ElementLines& elements, std::int32_t first);

/// A .neigh file; -1 stands for no neighbor in it, too.
void write_neighbors(FileSink& sink, std::span<const std::array<std::int32_t, 3>> neighbors, std::int32_t first);

/// An .edge file, or the segments of a .poly. `markers`: empty, or one for each edge.
void write_edges(FileSink& sink, std::span<const std::array<std::int32_t, 2>> edges,
                 std::span<const std::int32_t> markers, std::int32_t first);

}  // namespace driftmesh
