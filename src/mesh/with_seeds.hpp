#pragma once

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The same domain without polygons: hole points and seeds of regions mean what the polygons meant, and segments that
/// bound no part of the domain are gone. `pslg` must be as repair() leaves it. Throws what triangulate() throws.
[[nodiscard]] Pslg with_seeds(const Pslg& pslg);

}  // namespace driftmesh
