#pragma once

#include "driftmesh/pslg.hpp"
#include "sizing/medial_axis.hpp"

namespace driftmesh {

/// The segments that bound the domain which a PSLG describes. Segments with the domain on both sides are none of them.
/// `pslg` must be as repair() leaves it. Throws what triangulate() throws.
[[nodiscard]] OutlineSegments domain_outline(const Pslg& pslg);

}  // namespace driftmesh
