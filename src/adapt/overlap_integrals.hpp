#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "adapt/lineage.hpp"
#include "adapt/overlaps.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {

using Weights = std::array<double, 3>;

[[nodiscard]] inline double area_of(const Triangulation& mesh, TriangleId t) {
  return signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// Points as combinations of the corners of a triangle, not only those inside.
class WeightsIn {
 public:
  WeightsIn(const Triangulation& mesh, TriangleId t)
      : a_(mesh.corner(t, 0)), b_(mesh.corner(t, 1)), c_(mesh.corner(t, 2)), all_(rounded_cross(a_, b_, c_)) {}
  [[nodiscard]] Weights at(const Point& p) const {
    const double at_b = rounded_cross(c_, a_, p) / all_, at_c = rounded_cross(a_, b_, p) / all_;
    return {1 - at_b - at_c, at_b, at_c};
  }

 private:
  const Point &a_, &b_, &c_;
  double all_;
};

/// What an overlap adds to integrals over the new triangle.
class Share {
 public:
  Share(const Overlap& overlap, std::span<const Point> polygon, const Lineage::Change& change, double correction)
      : size_(polygon.size()), in_old_(), in_new_(), areas_() {
    const WeightsIn old_triangle(change.old_mesh, overlap.old_triangle);
    const WeightsIn new_triangle(change.new_mesh, overlap.new_triangle);
    for (std::size_t i = 0; i < size_; ++i) {
      in_old_[i] = old_triangle.at(polygon[i]);
      in_new_[i] = new_triangle.at(polygon[i]);
      if (i >= 2) areas_[i] = correction * signed_area(polygon[0], polygon[i - 1], polygon[i]);
    }
  }

  /// The integrals of the function that is linear in the old triangle, with these values at its corners, times that of
  /// each corner of the new one: exact in each of the triangles around the first corner of the polygon.
  [[nodiscard]] Weights moments(const std::array<double, 3>& at_old) const {
    std::array<double, OverlapList::kMostCorners> value{};
    for (std::size_t i = 0; i < size_; ++i)
      value[i] = in_old_[i][0] * at_old[0] + in_old_[i][1] * at_old[1] + in_old_[i][2] * at_old[2];
    Weights moments{};
    for (std::size_t i = 2; i < size_; ++i) {
      const double all = value[0] + value[i - 1] + value[i];
      for (std::size_t k = 0; k < 3; ++k)
        moments[k] += areas_[i] / 12 *
                      ((all + value[0]) * in_new_[0][k] + (all + value[i - 1]) * in_new_[i - 1][k] +
                       (all + value[i]) * in_new_[i][k]);
    }
    return moments;
  }

 private:
  std::size_t size_;
  std::array<Weights, OverlapList::kMostCorners> in_old_, in_new_;  // the corners of the polygon
  std::array<double, OverlapList::kMostCorners> areas_;             // those of the triangle that ends at each
};

/// What the new triangles of a subdomain overlap of those that are gone: all at once, or some at a time where there are
/// so many that they are found twice rather than kept.
class Overlaps {
 public:
  /// Other triangles have no overlaps but for rounding. `room`: memory for them.
  Overlaps(const Lineage::Change& change, OverlapList room);

  /// Goes on to the first ones, then to the next; false after the last.
  bool next();

  OverlapList found;
  IdVector<TriangleId, double>
      correction{};  ///< an old triangle's area over the sum of its overlaps: 1 but for rounding

 private:
  [[nodiscard]] std::function<bool(TriangleId)> is_new() const;
  bool find(OverlapFinder& finder);

  const Lineage::Change& change_;
  IdVector<TriangleId, bool> stays_;  // old triangles
  std::optional<OverlapFinder> again_;
  int left_ = 0;  // times that next() will find some
};

}  // namespace driftmesh::adapt
