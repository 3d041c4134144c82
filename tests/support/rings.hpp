#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh::testing {

/// Adds a ring of segments.
inline void add_ring(Pslg& pslg, const std::vector<Point>& ring, std::int32_t marker = 1) {
  const auto first = static_cast<std::int32_t>(pslg.points.size()), count = static_cast<std::int32_t>(ring.size());
  pslg.points.insert(pslg.points.end(), ring.begin(), ring.end());
  for (std::int32_t i = 0; i < count; ++i) pslg.segments.push_back({first + i, first + (i + 1) % count, marker});
}

/// Rings of segments, all with marker 1.
[[nodiscard]] inline Pslg pslg_of_rings(const std::vector<std::vector<Point>>& rings) {
  Pslg pslg;
  for (const std::vector<Point>& ring : rings) add_ring(pslg, ring);
  return pslg;
}

}  // namespace driftmesh::testing
