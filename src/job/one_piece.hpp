#pragma once

#include <cstdint>
#include <memory>

#include "job/place.hpp"

namespace driftmesh::job {

/// Refines the whole domain of the order in one piece. Stops at a limit, which is a shortfall then. `threads`: for the
/// inspection of the mesh.
[[nodiscard]] std::unique_ptr<Refined> refine_in_one_piece(Order&& order, const Limits& limits, std::int32_t threads,
                                                           Watch& watch);

}  // namespace driftmesh::job
