#pragma once

#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// The same load on ranks that are slower where they lack memory for their share of the work: what is in proportion to
/// these speeds fits, with 3 % to spare. All speeds are known then. What such ranks have is fixed: if it left, it would
/// make no room, since it may do so after others have come. Ranks with more work than their share keep their speed:
/// what they have needs no more memory.
[[nodiscard]] LoadSnapshot within_memory(LoadSnapshot snapshot);

}  // namespace driftmesh::balancer
