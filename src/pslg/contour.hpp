#pragma once

#include <cstddef>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Values at columns x rows grid points with this spacing, row by row from the origin.
struct Grid {
  std::size_t columns = 0;
  std::size_t rows = 0;
  double spacing = 1;
  std::vector<double> values;

  [[nodiscard]] std::size_t index(std::size_t column, std::size_t row) const { return row * columns + column; }
  [[nodiscard]] Point place(std::size_t i) const {
    const std::size_t column = i % columns, row = i / columns;
    return {static_cast<double>(column) * spacing, static_cast<double>(row) * spacing};
  }
  [[nodiscard]] bool on_frame(std::size_t i) const {
    const std::size_t column = i % columns, row = i / columns;
    return column == 0 || row == 0 || column + 1 == columns || row + 1 == rows;
  }
  [[nodiscard]] bool negative(std::size_t i) const { return values[i] < 0; }
};

/// A closed curve between negative and other values, the negative side to the left.
struct ContourLoop {
  struct Vertex {
    Point at;
    bool on_frame = false;  ///< next to a point of the frame
  };
  std::vector<Vertex> vertices;
  Point outside;  ///< a point of the grid to the right of the curve, next to it
};

/// Keeps only the largest connected set (by sides) of negative values, and makes small islands negative: sets of other
/// values, connected by sides or corners, that do not touch the frame and have fewer than `least` points. The frame
/// itself becomes positive.
void keep_main_basin(Grid& grid, std::size_t least);

/// All curves between negative and other values, by marching squares (W. Lorensen, H. Cline, SIGGRAPH 1987). They are
/// simple and do not touch each other: each side of a cell holds one vertex at most, kept away from its ends.
[[nodiscard]] std::vector<ContourLoop> trace_contours(const Grid& grid);

/// Twice the area enclosed by the loop, negative if it runs clockwise.
[[nodiscard]] double twice_signed_area(const ContourLoop& loop);

}  // namespace driftmesh
