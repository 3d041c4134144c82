#pragma once

#include <cmath>

#include "balancer/cost/move_cost.hpp"
#include "balancer/snapshot/deliberation.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// Whether planning is worthwhile: kDone if the possible gain, beyond noise, exceeds both the required one and the time
/// that planning takes, in seconds, and a rank runs out of work within `ahead` seconds. It notes what it finds, as
/// worth_moving() does (see Deliberation).
[[nodiscard]] Verdict outlook(const LoadSnapshot& snapshot, const Worth& worth, double cost_of_planning,
                              double ahead = HUGE_VAL);

}  // namespace driftmesh::balancer
