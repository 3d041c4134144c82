#pragma once

#include <cstdint>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/pslg.hpp"
#include "oracles/random_polygons.hpp"

namespace driftmesh::testing {

/// Polygons as raw rings, with the segments that join their corners.
[[nodiscard]] inline Pslg raw_rings(const oracles::RandomPolygons& set, std::int32_t marker = 0) {
  Pslg pslg;
  for (const oracles::GridPolygon& polygon : set.polygons) {
    Pslg::Polygon& taken = pslg.polygons.emplace_back();
    if (polygon.region) {
      taken.region = static_cast<std::int32_t>(pslg.regions.size());
      pslg.regions.push_back({{}, *polygon.region, 0});
    }
    for (const oracles::GridRing& ring : polygon.rings) {
      Pslg::Ring& corners = taken.rings.emplace_back();
      const auto first = static_cast<std::int32_t>(pslg.points.size()), n = static_cast<std::int32_t>(ring.size());
      for (std::int32_t i = 0; i < n; ++i) {
        const oracles::GridPoint& p = ring[to_index(i)];
        pslg.points.push_back(
            {static_cast<double>(set.origin.x + p.x) * set.unit, static_cast<double>(set.origin.y + p.y) * set.unit});
        corners.push_back(first + i);
        pslg.segments.push_back({first + i, first + (i + 1) % n, marker});
      }
    }
  }
  return pslg;
}

}  // namespace driftmesh::testing
