#pragma once

#include <memory>

#include "driftmesh/point.hpp"
#include "geometry/box.hpp"
#include "sizing/variation.hpp"

namespace driftmesh {

/// A function of position that size expressions may contain, beside x and y, or that they are. Queries depend on their
/// arguments alone, and may run in several threads at once.
class PlaneFunction {
 public:
  virtual ~PlaneFunction() = default;
  /// NaN where there is no value.
  [[nodiscard]] virtual double at(const Point& p) const = 0;
  /// Holds at(p) for all points of a box, whose ends may be infinite, and the slopes between them.
  [[nodiscard]] virtual Variation over(const Box& box) const = 0;
  /// The same function for questions about points of a finite box and boxes in it alone, which it answers faster and
  /// more closely. Null if it would be no better than this one.
  [[nodiscard]] virtual std::shared_ptr<const PlaneFunction> within(const Box& /*box*/) const { return nullptr; }
};

}  // namespace driftmesh
