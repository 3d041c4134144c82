#pragma once

#include "geometry/point.hpp"

namespace driftmesh {

/// A target edge length as a function of position. A triangle is too large when its area exceeds sqrt(3)/4 h^2 with h
/// the smallest value of the field at its corners and centroid: the area of the equilateral triangle of that side.
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// The target edge length at `p`: > 0, or +infinity where the field sets no bound. Depends on `p` alone: every rank
  /// that evaluates it gets the same bits. Not safe to call on one object from two threads.
  [[nodiscard]] virtual double edge_length(const Point& p) const = 0;
};

}  // namespace driftmesh
