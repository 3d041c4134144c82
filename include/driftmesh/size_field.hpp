#pragma once

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A target edge length as a function of position, in the units of the coordinates. A triangle is too large if its area
/// exceeds sqrt(3)/4 h^2, the area of the equilateral triangle with edges of length h, where h is the smallest value of
/// the field at its corners and its centroid.
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// The target edge length at `p`: > 0, or +infinity where the field sets no bound. Must depend on `p` alone and
  /// return the same bits on every rank. May throw; the exception ends meshing and propagates to the caller. Never
  /// called on one object from two threads at once.
  [[nodiscard]] virtual double edge_length(const Point& p) const = 0;
  /// The same, so that MeshOptions::size takes std::ref(field).
  [[nodiscard]] double operator()(const Point& p) const { return edge_length(p); }
};

}  // namespace driftmesh
