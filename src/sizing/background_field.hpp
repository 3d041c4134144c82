#pragma once

#include <vector>

#include "driftmesh/size_field.hpp"
#include "geometry/box_tree.hpp"
#include "sizing/background_mesh.hpp"

namespace driftmesh {

/// A length at each point of a background mesh, linear on each triangle; outside the mesh the value at the nearest
/// point of its boundary. falls_below finds every length that the mesh holds in a triangle, up to rounding.
class VertexSizeField final : public SizeField {
 public:
  /// One length for each point of the mesh: > 0, or +infinity for no bound, which then holds for all of each triangle
  /// with such a corner. Throws Error otherwise. To limit their growth see limit_gradation.
  VertexSizeField(BackgroundMesh mesh, std::vector<double> lengths);
  [[nodiscard]] const BackgroundMesh& mesh() const { return mesh_; }
  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] double least() const override { return least_; }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;
  /// The points of the mesh.
  void visit_marks(const std::function<void(const Point&)>& visit) const override;

 private:
  BackgroundMesh mesh_;
  std::vector<double> lengths_;
  double least_;
  std::vector<BackgroundMesh::Ends> edges_;
  BoxTree edge_tree_;
  BoxTree::Least shorter_ends_;  // the shorter of the lengths at the ends
};

/// An area bound for each triangle of a background mesh, as in the .area files of Triangle; the target edge length
/// is the side of the equilateral triangle of that area. On an edge or corner between triangles the largest of their
/// bounds holds, so that a fine triangle of the background does not reach into its neighbors; outside the mesh the
/// bound at the nearest point of its boundary. falls_below finds every triangle of the mesh that overlaps one by more
/// than rounding.
class TriangleAreaField final : public SizeField {
 public:
  /// One bound for each triangle; <= 0 for none. Throws Error when there are more or fewer, or one is not a number.
  TriangleAreaField(BackgroundMesh mesh, const std::vector<double>& area_bounds);
  [[nodiscard]] const BackgroundMesh& mesh() const { return mesh_; }
  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] double least() const override { return least_; }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;
  /// The centroids of the triangles.
  void visit_marks(const std::function<void(const Point&)>& visit) const override;

 private:
  BackgroundMesh mesh_;
  std::vector<double> lengths_;  // one for each triangle
  double least_;
  BoxTree::Least shortest_;
};

/// The side of the equilateral triangle of the given area; +infinity for an area <= 0, which stands for no bound.
[[nodiscard]] double edge_length_of_area(double area);

/// For each point the shortest of the lengths of the triangles around it; +infinity where there is none.
[[nodiscard]] std::vector<double> shortest_at_points(const BackgroundMesh& mesh,
                                                     const std::vector<double>& lengths_of_triangles);

}  // namespace driftmesh
