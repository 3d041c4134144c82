#pragma once

#include "geometry/triangle_geometry.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The number of triangles that refinement makes, relative to area / bound (measured at 20 degrees).
inline constexpr double kTrianglesPerBound = 1.55;

/// The area of all triangles.
[[nodiscard]] double area_of(const Triangulation& mesh);

/// How many triangles the bounds on area and size ask for, by themselves: the area over the mean area of triangles.
class BoundForecast {
 public:
  /// The mesh must outlive it.
  BoundForecast(const Triangulation& mesh, const SizeBounds& sizes);

  /// The number in triangle t, which has this area, as a fraction: 0 without a bound.
  [[nodiscard]] double in(TriangleId t, double twice_area) const;
  /// The sum over all triangles, each of which counts at least as one. Within a few percent of the final number where
  /// these bounds decide; triangles that only the angle bound requires are not in it.
  [[nodiscard]] double total() const;
  /// The same without rounding up: what the bounds ask for.
  [[nodiscard]] double asked() const;

 private:
  const Triangulation& mesh_;
  AreaBounds areas_;
  IdVector<VertexId, double> at_vertices_;  // lengths, where there are triangles
};

/// Not less than the total, and takes no more than a look at each triangle: with the least length that is asked for
/// anywhere. Not a finite number if that is unknown.
[[nodiscard]] double most_in_total(const Triangulation& mesh, const SizeBounds& sizes);

}  // namespace driftmesh
