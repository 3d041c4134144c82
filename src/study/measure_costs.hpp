#pragma once

#include "runtime/run_plan.hpp"

namespace driftmesh::study {

/// What work takes on this machine, in CPU time: some ten seconds. `quick` measures small cases once.
[[nodiscard]] CostModel measure_costs(bool quick);

/// The planning of moves alone.
[[nodiscard]] balancer::PlanningCosts measure_planning(bool quick);

}  // namespace driftmesh::study
