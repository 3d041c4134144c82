#pragma once

#include <cstdint>
#include <functional>

#include "cluster/cluster_run.hpp"
#include "cluster/cluster_spec.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// What happens during the simulation; each may be empty.
struct SimulationObservers {
  std::function<void(std::int64_t triangles)> progress;  ///< of all ranks together, now and then
  std::function<void(const RankLoop& rank)> finished;    ///< each, in their order, once all is done
};

/// Runs `plan` on ranks that exist in this process alone. The meshes are made, and every message is sent, received and
/// decoded by the code of a real run; time alone is simulated: work passes by `costs` over the speed of the rank, and
/// messages by the cluster's network. The same arguments give the same result on every machine.
///
/// All of the mesh is held in memory, about 45 bytes a triangle. Throws Error if plan and cluster do not fit each
/// other, and what refinement throws.
[[nodiscard]] ClusterRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs = {},
                                  const SimulationObservers& observers = {});

}  // namespace driftmesh
