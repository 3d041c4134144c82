#pragma once

#include <algorithm>
#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// By how much, as a fraction, refinement stays below the bounds of request and regions, so that they hold for readers
/// who compute areas with other rounding.
inline constexpr double kMarginOfRefinement = 1e-12;

/// Which triangles are larger than request, region and size field allow. All areas are twice those of triangles.
class AreaBounds {
 public:
  /// Mesh and size field must outlive it. The bounds of request and regions are taken lower by this fraction.
  AreaBounds(const Triangulation& mesh, const QualityBounds& bounds, double margin = 0);

  /// The bound of the request and of the region of triangle t, without the size field.
  [[nodiscard]] double constant(TriangleId t) const {
    return by_region_.size() > 1 && !mesh_.region.empty() ? by_region_[mesh_.region[t]] : by_region_[0];
  }
  /// The least of those.
  [[nodiscard]] double least_constant() const { return *std::ranges::min_element(by_region_); }
  /// Whether no triangle of this area, or of less, can be too large, wherever it is.
  [[nodiscard]] bool surely_hold(double twice_area) const {
    return size_ == nullptr && (by_region_.size() == 1 || mesh_.region.empty()) && twice_area <= by_region_[0];
  }

  [[nodiscard]] bool has_size() const { return size_ != nullptr; }
  /// Whether the size field asks for less than a triangle with these corners: at one of them, where `at_corners()` is
  /// the least of its values, at the centroid or, if that is wanted, somewhere between them. It is asked first what
  /// lets most triangles pass that are small enough. Only if there is one.
  template <class AtCorners>
  [[nodiscard]] bool above_size(const CornerPoints& corners, double twice_area, AtCorners&& at_corners,
                                bool between) const {
    const auto above = [&](double h) { return twice_area > twice_area_of_edge(h); };
    if (twice_area <= twice_area_of_least_ || !above(size_->least_near(corners))) return false;
    const double least = at_corners();
    if (above(least)) return true;
    if (!above(size_->least_between(corners, least))) return false;
    return above(size_->edge_length(centroid(corners))) || (between && above_size_between(corners, twice_area));
  }
  /// The same between corners and centroid alone.
  [[nodiscard]] bool above_size_between(const CornerPoints& corners, double twice_area) const {
    return twice_area > twice_area_of_least_ && size_->falls_below(corners, edge_of_twice_area(twice_area));
  }

 private:
  const Triangulation& mesh_;
  const SizeField* size_;
  std::vector<double> by_region_;  // by region label; the first is that of the request
  double twice_area_of_least_;     // for the least length of the size field
};

}  // namespace driftmesh
