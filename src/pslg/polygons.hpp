#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Makes corners that follow each other different points. No corner is left of a ring that stays at one point.
void drop_repetitions(Pslg::Ring& ring);

/// Takes the edges in `gone` off a ring, each named by the pair_key() of its ends. The ring walks each of them there
/// and back, and turns before it from now on. None of its corners is left if it has no other edges.
void retract(Pslg::Ring& ring, const std::unordered_set<std::uint64_t>& gone);

/// For each region, whether a polygon names it, so that it has no seed.
[[nodiscard]] std::vector<bool> regions_of_polygons(const Pslg& pslg);

/// For each segment of a repaired input, whether a ring of a polygon walks along it.
[[nodiscard]] std::vector<bool> segments_of_rings(const Pslg& pslg);

}  // namespace driftmesh
