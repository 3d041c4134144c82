#include "mesh/bounds.hpp"

#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

void require_possible(const QualityBounds& bounds) {
  if (!(bounds.min_angle >= 0 && bounds.min_angle <= kMaxAngle))
    throw Error("the angle bound must lie between 0 and " + std::to_string(static_cast<int>(kMaxAngle)) +
                " degrees: refinement may not terminate above that");
  if (std::isnan(bounds.max_area)) throw Error("the area bound is not a number");
}

}  // namespace driftmesh
