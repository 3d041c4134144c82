#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Makes corners that follow each other different points. No corner is left of a ring that stays at one point.
void drop_repetitions(Pslg::Ring& ring);

/// For each region, whether a polygon names it, so that it has no seed.
[[nodiscard]] std::vector<bool> regions_of_polygons(const Pslg& pslg);

/// For each segment of a repaired input, whether a ring of a polygon walks along it.
[[nodiscard]] std::vector<bool> segments_of_rings(const Pslg& pslg);

}  // namespace driftmesh
