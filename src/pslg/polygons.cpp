#include "pslg/polygons.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "pslg/segment_finder.hpp"

namespace driftmesh {

void drop_repetitions(Pslg::Ring& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (!ring.empty() && ring.front() == ring.back()) ring.pop_back();
}

std::vector<bool> regions_of_polygons(const Pslg& pslg) {
  std::vector<bool> named(pslg.regions.size(), false);
  for (const Pslg::Polygon& polygon : pslg.polygons)
    if (polygon.region >= 0) named[polygon.region] = true;
  return named;
}

std::vector<bool> segments_of_rings(const Pslg& pslg) {
  std::vector<bool> walked(pslg.segments.size(), false);
  if (pslg.polygons.empty()) return walked;
  const SegmentFinder finder(pslg);
  for (const Pslg::Polygon& polygon : pslg.polygons)
    for (const Pslg::Ring& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (const std::int32_t s = finder.between(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]); s >= 0)
          walked[s] = true;
  return walked;
}

}  // namespace driftmesh
