#pragma once

#include <memory>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"
#include "geometry/box.hpp"
#include "sizing/interval.hpp"

namespace driftmesh {

/// A function of position that size expressions may contain, beside x and y. Queries depend on their arguments alone,
/// and may run in several threads at once.
class PlaneFunction {
 public:
  virtual ~PlaneFunction() = default;
  [[nodiscard]] virtual double at(const Point& p) const = 0;
  /// Holds at(p) for all points of a box, whose ends may be infinite.
  [[nodiscard]] virtual Interval over(const Box& box) const = 0;
};

/// The variable of an expression that stands for a function.
struct PlaneVariable {
  std::string name;
  std::shared_ptr<const PlaneFunction> function;
};
using PlaneVariables = std::vector<PlaneVariable>;

}  // namespace driftmesh
