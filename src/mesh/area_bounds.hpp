#pragma once

#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "mesh/size_bound.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// By how much, as a fraction, refinement stays below the bounds by region, so that they hold for readers who compute
/// areas with other rounding.
inline constexpr double kMarginOfRefinement = 1e-12;

/// Which triangles of a mesh are larger than the bounds on sizes allow. All areas are twice those of triangles.
class AreaBounds {
 public:
  /// The mesh must outlive it. Bounds by region are taken lower by this fraction.
  AreaBounds(const Triangulation& mesh, SizeBounds sizes, double margin = 0);

  [[nodiscard]] const SizeBounds& sizes() const { return sizes_; }

  /// The bound by the region of triangle t.
  [[nodiscard]] double constant(TriangleId t) const {
    return by_region_.size() > 1 && !mesh_.region.empty() ? by_region_[mesh_.region[t]] : by_region_[0];
  }
  /// The least of those.
  [[nodiscard]] double least_constant() const { return *std::ranges::min_element(by_region_); }
  /// Whether no triangle of this area, or of less, can be too large, wherever it is.
  [[nodiscard]] bool surely_hold(double twice_area) const {
    return !by_place_ && (by_region_.size() == 1 || mesh_.region.empty()) && twice_area <= by_region_[0];
  }

  [[nodiscard]] bool by_place() const { return by_place_; }
  /// Whether less than a triangle with these corners is asked for by place: at one of them, where `at_corners()` is the
  /// least length, at the centroid or, if that is wanted, somewhere between them. It is asked first what lets most
  /// triangles pass that are small enough. Only if there is a bound by place.
  template <class AtCorners>
  [[nodiscard]] bool above_size(const CornerPoints& corners, double twice_area, AtCorners&& at_corners,
                                bool between) const {
    const auto above = [&](double h) { return twice_area > twice_area_of_edge(h); };
    if (twice_area <= twice_area_of_least_) return false;
    const double least = at_corners();
    if (above(least)) return true;
    if (!above(sizes_.least_between(corners, least))) return false;
    return above(sizes_.length_at(centroid(corners))) || (between && above_size_between(corners, twice_area));
  }
  /// The same between corners and centroid alone.
  [[nodiscard]] bool above_size_between(const CornerPoints& corners, double twice_area) const {
    return twice_area > twice_area_of_least_ && sizes_.falls_below(corners, edge_of_twice_area(twice_area));
  }

 private:
  const Triangulation& mesh_;
  SizeBounds sizes_;
  bool by_place_;
  std::vector<double> by_region_;  // by label
  double twice_area_of_least_;     // for the least length
};

}  // namespace driftmesh
