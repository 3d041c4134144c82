#include "decompose/work.hpp"

#include <algorithm>

namespace driftmesh {

double work_density(const SizeBounds& sizes, std::uint16_t region) {
  if (const double bound = sizes.twice_area(region) / 2; bound < kNoBound) return kTrianglesPerBound / bound;
  double largest = 0;
  for (std::size_t label = 0; label < sizes.regions(); ++label)
    if (const double bound = sizes.twice_area(label) / 2; bound < kNoBound) largest = std::max(largest, bound);
  return largest > 0 ? 0.1 * kTrianglesPerBound / largest : 1;
}

}  // namespace driftmesh
