#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh::triangle {

using Pair = std::array<std::int32_t, 2>;

/// What Triangle's files and its C structure hold: an input, a mesh, or both. All indices start at 0, whatever files
/// and callers count from. Arrays documented as "empty, or" have either no entries or exactly one for each point,
/// triangle or segment.
struct Tables {
  std::vector<Point> points;
  std::vector<double> point_attributes;  ///< attributes_per_point for each point, point by point
  std::int32_t attributes_per_point = 0;
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point

  /// Corners counterclockwise, triangle by triangle; with six corners the midpoints of the edges opposite to the first,
  /// second and third corner follow.
  std::vector<std::int32_t> triangles;
  std::int32_t corners = 3;
  std::vector<double> triangle_attributes;  ///< attributes_per_triangle for each triangle, triangle by triangle
  std::int32_t attributes_per_triangle = 0;
  std::vector<double> triangle_areas;                    ///< empty, or the largest area within each; <= 0: no bound
  std::vector<std::array<std::int32_t, 3>> neighbors{};  ///< across the edge opposite to each corner; -1: none

  std::vector<Pair> segments;
  std::vector<std::int32_t> segment_markers;  ///< empty, or one for each segment
  std::vector<Point> holes;
  std::vector<Pslg::Region> regions;

  std::vector<Pair> edges;
  std::vector<std::int32_t> edge_markers;  ///< empty, or one for each edge

  [[nodiscard]] std::size_t triangle_count() const { return triangles.size() / static_cast<std::size_t>(corners); }
};

/// The Voronoi diagram of a mesh: a point for each triangle, in their order, and an edge for each edge of the mesh.
struct Voronoi {
  std::vector<Point> points;
  std::vector<double> point_attributes;  ///< as many for each point as the mesh has, extended from its triangle
  std::vector<Pair> edges;               ///< the triangles beside each edge; the second is -1 for a ray to infinity
  std::vector<Point> directions;         ///< where rays go; (0, 0) for all other edges
};

}  // namespace driftmesh::triangle
