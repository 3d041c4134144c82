#pragma once

#include <functional>

#include "mesh/bound_forecast.hpp"
#include "mesh/bounds.hpp"
#include "mesh/feature_sizes.hpp"
#include "mesh/growth.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A forecast of the number of triangles that refinement makes of a constrained Delaunay triangulation (corners
/// prepared, not refined), and of where they are.
///
/// Two things demand triangles: the bounds on area and size (see BoundForecast), and, because of the bound on angles,
/// the details of the input, away from which triangles grow only so fast. The number of the latter is the integral of
/// 1 / h^2, up to a factor, over a size h that grows linearly away from details (Ruppert 1995; Mitchell, "Cardinality
/// bounds for triangulations with bounded minimum angle", 1994). Here it is a sum over the corners of triangles of the
/// triangulation, each with the size at its vertex (feature_sizes) and integrals in closed form (growth.hpp). At each
/// distance from a corner the finer one of growth and bound counts. In addition:
///
/// - A triangle that meets the angle bound and has no smaller details around it stays one triangle.
/// - Between segments that run side by side, triangles are about as small as their distance (channel.hpp).
/// - In the wedge of an acute corner, triangles span it from one segment to the other; only their lengths grow.
///
/// Within a factor of 1.5 of the number that refinement makes on the inputs that tests try (2 above 30 degrees, and
/// where details are drawn at random), most within 1.25. Takes linear time. The sum is invariant under scaling by
/// powers of two, and, but for rounding, under rigid motions.
class Forecast {
 public:
  /// Both must outlive it.
  Forecast(const Triangulation& mesh, const QualityBounds& bounds);

  /// The number of triangles that will cover triangle t; at least one.
  [[nodiscard]] double in(TriangleId t) const;
  [[nodiscard]] double total() const;

  /// Calls visit(place, triangles) so that each visit stands for about `quota` triangles around the place.
  /// Deterministic.
  void visit_samples(double quota, const std::function<void(const Point& at, double triangles)>& visit) const;

 private:
  struct Shape;
  [[nodiscard]] Shape shape_of(TriangleId t, double twice_area, double asked) const;
  void set_sizes(Shape& s) const;
  [[nodiscard]] bool meets_angle_bound(double twice_area, double bc, double ca, double ab) const;
  [[nodiscard]] double least_size(TriangleId t) const;
  [[nodiscard]] bool is_plain(TriangleId t, double twice_area, double asked) const;
  [[nodiscard]] double detailed(const Shape& s) const;
  [[nodiscard]] double grown(const Shape& s) const;
  [[nodiscard]] double growth_density(const Shape& s, const Point& p, double stretch) const;
  [[nodiscard]] double along_wedge(const Shape& s, int i) const;
  [[nodiscard]] double density(const Shape& s, const Point& p) const;
  void spread(const Shape& s, const CornerPoints& part, double count, double quota, int halvings,
              const std::function<void(const Point& at, double triangles)>& visit) const;

  const Triangulation& mesh_;
  BoundForecast bound_;
  Growth growth_;
  double flatness_;                       // 1, less for small angle bounds
  double sin_squared_;                    // for the angle bound
  GrowingArray<double, VertexId> sizes_;  // at vertices; empty without an angle bound
};

/// The sum of a Forecast.
[[nodiscard]] double forecast_triangles(const Triangulation& mesh, const QualityBounds& bounds);

}  // namespace driftmesh
