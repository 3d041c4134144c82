#pragma once

#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/carve.hpp"
#include "mesh/nested_rings.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// What the author of an input may not have meant, in words, with the numbers of the file: flaws of polygons, segments
/// that bound no part of the domain, regions that no segments separate, and rings of segments that are neither holes
/// nor regions. `pslg` has been repaired, as `repairs` reports, and triangulated to `carved`.
[[nodiscard]] std::vector<std::string> domain_warnings(const Pslg& pslg, const RepairReport& repairs,
                                                       const CarveReport& report, const Triangulation& carved);

}  // namespace driftmesh
