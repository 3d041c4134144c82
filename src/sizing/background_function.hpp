#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sizing/background_mesh.hpp"
#include "sizing/nearest_in_square.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// Target edge lengths on the triangles of a background mesh; outside of it, that at the nearest point of its boundary.
class BackgroundFunction final : public PlaneFunction {
 public:
  /// One length for each point, linear on each triangle: > 0, or +infinity for no bound, which then holds for all of
  /// each triangle with such a corner but its other corners and the edge between them. Where triangles meet or overlap,
  /// the least counts. Throws Error otherwise. To limit their growth see limit_gradation.
  [[nodiscard]] static std::shared_ptr<const BackgroundFunction> of_points(std::shared_ptr<const BackgroundMesh> mesh,
                                                                           std::vector<double> lengths);
  /// An area bound for each triangle, as in the .area files of Triangle, <= 0 for none; the length is the side of the
  /// equilateral triangle of that area. Where triangles meet the largest bound counts, so that a fine triangle does not
  /// reach into its neighbors. Throws Error when there are more or fewer, or one is not a number.
  [[nodiscard]] static std::shared_ptr<const BackgroundFunction> of_areas(std::shared_ptr<const BackgroundMesh> mesh,
                                                                          const std::vector<double>& area_bounds);

  [[nodiscard]] const std::shared_ptr<const BackgroundMesh>& mesh() const { return all_->mesh; }
  [[nodiscard]] double at(const Point& p) const override;
  /// The slopes are those of the triangles where these cover the box; unknown elsewhere.
  [[nodiscard]] Variation over(const Box& box) const override;
  /// Knows the triangles that touch the box, and the edges of the boundary that can be nearest, if they are few.
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;
  /// Calls visit(p) for the points where lengths may be least: those of the mesh, or the centroids of its triangles.
  void visit_marks(const std::function<void(const Point&)>& visit) const;

 private:
  struct All {
    std::shared_ptr<const BackgroundMesh> mesh;
    std::vector<double> lengths;
    bool of_areas;
    double least, most;
    [[nodiscard]] std::array<double, 3> at_corners(std::int32_t triangle) const;
  };
  /// A triangle and the lengths at its corners.
  struct Piece {
    Piece(const CornerPoints& triangle, const std::array<double, 3>& at_corners);
    Box box;
    CornerPoints corners;
    std::array<double, 3> lengths;
    double least, most;
    Point gradient;  // (0, 0) where a length is infinite
    [[nodiscard]] bool touches(const Box& other) const;
    [[nodiscard]] Interval over(const Box& other) const;
  };
  /// An edge of the boundary.
  struct Rim {
    std::int32_t number;
    Point a, b;
    double at_a, at_b;
    [[nodiscard]] double squared_distance(const Point& p) const;
    [[nodiscard]] bool touches(const Box& box) const;
    [[nodiscard]] double at(const Point& p) const;
    [[nodiscard]] Interval over(const Box& box) const;
  };
  /// What counts in a box.
  struct Part {
    std::vector<Piece> pieces;
    std::vector<Rim> rims;  // by number; none where triangles cover the box
    bool is_few;            // otherwise all count
  };
  BackgroundFunction(std::shared_ptr<const All> all, Part part);

  [[nodiscard]] Piece piece(std::int32_t triangle) const;
  [[nodiscard]] Rim rim(std::int32_t edge) const;
  [[nodiscard]] Rim nearest_rim(const Point& p) const;
  [[nodiscard]] Part part_in(const Box& box, std::size_t most) const;
  [[nodiscard]] std::vector<Rim> rims_near(const Box& box, std::size_t most) const;
  [[nodiscard]] Variation over_few(const Box& box) const;

  std::shared_ptr<const All> all_;
  Part part_;
};

/// The side of the equilateral triangle of the given area; +infinity for an area <= 0, which stands for no bound.
[[nodiscard]] double edge_length_of_area(double area);

/// For each point the shortest of the lengths of the triangles around it; +infinity where there is none.
[[nodiscard]] std::vector<double> shortest_at_points(const BackgroundMesh& mesh,
                                                     const std::vector<double>& lengths_of_triangles);

}  // namespace driftmesh
