#include "decompose/work.hpp"

#include <algorithm>

namespace driftmesh {

double work_density(const QualityBounds& bounds, std::uint16_t region) {
  if (const double bound = area_bound(bounds, region); bound < kNoBound) return kTrianglesPerBound / bound;
  double largest = 0;
  for (std::size_t r = 0; r < bounds.region_max_area.size(); ++r)
    if (const double b = area_bound(bounds, static_cast<std::uint16_t>(r)); b < kNoBound)
      largest = std::max(largest, b);
  return largest > 0 ? 0.1 * kTrianglesPerBound / largest : 1;
}

}  // namespace driftmesh
