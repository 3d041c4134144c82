#pragma once

#include <cstdint>

#include "mesh/bound_forecast.hpp"
#include "mesh/size_bound.hpp"

namespace driftmesh {

/// The density of work, per area, in the region with this label. 1 everywhere if there is no bound on size; if only
/// some regions have one, the others count as a tenth of the least dense of these.
[[nodiscard]] double work_density(const SizeBounds& sizes, std::uint16_t region);

}  // namespace driftmesh
