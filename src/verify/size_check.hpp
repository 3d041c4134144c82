#pragma once

#include <array>
#include <optional>
#include <vector>

#include "driftmesh/point.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box_tree.hpp"

namespace driftmesh {

/// What a size field asks for inside the triangles of a mesh, by its values at points alone: what the field knows of
/// triangles is what the mesher used.
class SizeCheck {
 public:
  /// Between corners, centroid and the marks of the field an edge may be 1 / 0.8 times what is asked for.
  static constexpr double kTolerated = 0.8;

  using Triangle = std::array<Point, 3>;

  /// Besides the marks, the field is looked up at 16 points of each triangle, and at four for each square of the
  /// spacing if it has more, but no more than for `most_area`: a larger triangle, which does not fit into the domain,
  /// must not take forever. 0: no spacing. `field` must outlive the object. `at_corners`: an edge may be 1 / this times
  /// what is asked for at corners, centroid and marks.
  SizeCheck(const SizeField& field, double spacing, double most_area, double at_corners = 1);

  /// The length up to which an edge may be for what is asked for at the corners and the centroid.
  [[nodiscard]] double at_corners(const Triangle& triangle) const;

  struct Miss {
    Point at;
    double length;  ///< asked for there
  };
  /// A point of a triangle with this area where too short an edge is asked for, if one is found.
  [[nodiscard]] std::optional<Miss> find_miss(const Triangle& triangle, double area) const;

 private:
  [[nodiscard]] std::optional<Miss> at_marks(const Triangle& corners, double edge) const;
  [[nodiscard]] std::optional<Miss> at_samples(const Triangle& corners, double area, double edge) const;

  const SizeField& field_;
  double spacing_;
  double most_area_, at_corners_;
  std::vector<Miss> marks_;
  BoxTree mark_tree_;
};

}  // namespace driftmesh
