#include "mesh/bounds.hpp"

#include <algorithm>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

std::vector<double> region_areas(const Pslg& pslg) {
  std::vector<double> areas{0};
  for (const Pslg::Region& region : pslg.regions) areas.push_back(region.max_area);
  return areas;
}

void require_possible(const QualityBounds& bounds) {
  if (!(bounds.min_angle >= 0 && bounds.min_angle <= kMaxAngle))
    throw Error("the angle bound must lie between 0 and " + std::to_string(static_cast<int>(kMaxAngle)) +
                " degrees: refinement may not terminate above that");
  if (std::isnan(bounds.max_area)) throw Error("the area bound is not a number");
}

double area_bound(const QualityBounds& bounds, std::uint16_t region) {
  double bound = bounds.max_area > 0 ? bounds.max_area : kNoBound;
  if (region < bounds.region_max_area.size() && bounds.region_max_area[region] > 0)
    bound = std::min(bound, bounds.region_max_area[region]);
  return bound;
}

}  // namespace driftmesh
