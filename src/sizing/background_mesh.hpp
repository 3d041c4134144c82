#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "driftmesh/point.hpp"
#include "geometry/box_tree.hpp"

namespace driftmesh {

/// Triangles that carry a size field, indexed to find the one that contains a point. Any set of triangles will do: with
/// holes, in several pieces, of either orientation. Triangles without area are ignored.
class BackgroundMesh {
 public:
  using Triangle = std::array<std::int32_t, 3>;

  /// A point as a convex combination of the corners of a triangle. Weights are >= 0 and sum to 1.
  struct Place {
    std::int32_t triangle;
    std::array<double, 3> weight;
  };

  /// Corners are indices into `points`, whose coordinates are in the range of the predicates. Throws Error when a
  /// corner does not exist or no triangle has an area.
  BackgroundMesh(std::vector<Point> points, std::vector<Triangle> triangles);

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }  ///< counterclockwise
  [[nodiscard]] const BoxTree& triangle_tree() const { return triangle_tree_; }
  [[nodiscard]] std::array<Point, 3> corners(std::int32_t triangle) const {
    return {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
  }
  [[nodiscard]] bool has_area(std::int32_t triangle) const { return has_area_[triangle]; }

  /// Whether all of a triangle lies in the mesh, as far as its corners and the edges on the boundary of the mesh tell:
  /// no such edge passes through the triangle. Up to rounding.
  [[nodiscard]] bool covers(const std::array<Point, 3>& triangle) const;
  /// The same for a box; true for an empty one.
  [[nodiscard]] bool covers(const Box& box) const;
  /// A point of the triangle that is not in the mesh, by more than rounding, if there is one.
  [[nodiscard]] std::optional<Point> uncovered(const std::array<Point, 3>& triangle) const;

  /// An edge of a triangle with an area.
  struct Edge {
    std::int32_t low, high;  ///< the ends
    std::int32_t triangle;
    std::uint8_t corner;  ///< it runs from this corner of the triangle to the next
    bool rising;          ///< from low to high
    [[nodiscard]] bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
  };
  /// The edges that have a triangle on one side alone.
  [[nodiscard]] const std::vector<Edge>& boundary() const { return boundary_; }
  [[nodiscard]] const BoxTree& boundary_tree() const { return boundary_tree_; }

  /// The place of `p` in the triangle that contains it, the one with the lowest index on a shared edge or corner. For a
  /// point outside the mesh, the place of the nearest point of its boundary. Depends on `p` alone.
  [[nodiscard]] Place locate(const Point& p) const;

 private:
  [[nodiscard]] const Point& corner(std::int32_t triangle, std::size_t i) const {
    return points_[triangles_[triangle][i]];
  }
  template <class Visit>
  void visit_triangles_with(const Point& p, Visit&& visit) const;
  [[nodiscard]] std::vector<Edge> edges() const;
  void connect(const std::vector<Edge>& edges);
  [[nodiscard]] Place walk_to(const Point& p) const;
  [[nodiscard]] bool is_outside(const Point& p, double by_more_than) const;
  [[nodiscard]] Place nearest_on_boundary(const Point& p) const;

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;  // counterclockwise
  std::vector<bool> has_area_;
  std::vector<Triangle> neighbors_;  // across the edge from each corner to the next; -1: none
  BoxTree triangle_tree_;
  std::vector<Edge> boundary_;
  BoxTree boundary_tree_;
};

}  // namespace driftmesh
