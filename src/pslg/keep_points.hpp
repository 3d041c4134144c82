#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Removes points with their markers and attributes, and numbers the ends of segments and the corners of rings anew.
/// Corners that go leave their rings, which may have none left; no segment may end at a point that goes. Returns the
/// former index of each point that stays.
std::vector<std::int32_t> keep_points(Pslg& pslg, const std::vector<bool>& gone);

}  // namespace driftmesh
