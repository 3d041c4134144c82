#include "mesh/bounds.hpp"

#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

std::vector<double> areas_by_region(const Pslg& pslg) {
  std::vector<double> areas{0};
  for (const Pslg::Region& region : pslg.regions) areas.push_back(region.max_area);
  return areas;
}

void require_possible(double min_angle) {
  if (!(min_angle >= 0 && min_angle <= kMaxAngle))
    throw Error("the angle bound must lie between 0 and " + std::to_string(static_cast<int>(kMaxAngle)) +
                " degrees: refinement may not terminate above that");
}

}  // namespace driftmesh
