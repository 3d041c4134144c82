#include "pslg/polygons.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "pslg/pair_key.hpp"
#include "pslg/segment_finder.hpp"

namespace driftmesh {

void drop_repetitions(Pslg::Ring& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (!ring.empty() && ring.front() == ring.back()) ring.pop_back();
}

void retract(Pslg::Ring& ring, const std::unordered_set<std::uint64_t>& gone) {
  const auto is_gone = [&](std::int32_t from, std::int32_t to) { return gone.contains(pair_key(from, to)); };
  // A turn may lie where the ring begins: so it begins with an edge that stays, if there is one.
  std::size_t first = 0;
  while (first < ring.size() && is_gone(ring[first], ring[(first + 1) % ring.size()])) ++first;
  if (first == ring.size()) return ring.clear();
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(first), ring.end());
  Pslg::Ring kept;
  for (const std::int32_t corner : ring)
    if (kept.size() > 1 && kept[kept.size() - 2] == corner && is_gone(kept.back(), corner))
      kept.pop_back();
    else
      kept.push_back(corner);
  if (kept.size() > 1 && is_gone(kept.back(), kept.front())) kept.pop_back();
  drop_repetitions(kept);
  ring = std::move(kept);
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
