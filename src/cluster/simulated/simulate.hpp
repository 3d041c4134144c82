#pragma once

#include <cstdint>
#include <functional>

#include "cluster/cluster_run.hpp"
#include "cluster/cluster_spec.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Callbacks during the simulation; each may be empty.
struct SimulationObservers {
  std::function<void(std::int64_t triangles)> progress;  ///< called from time to time with the sum over all ranks
  std::function<void(const RankLoop& rank)> finished;    ///< each rank, in order, once all are done
};

/// Runs `plan` on simulated ranks within this process. The meshes are really made, and every message is sent, received
/// and decoded by the code of a real run; only time is simulated: work takes `costs` divided by the speed of the rank,
/// and messages take what the cluster's network takes. The same arguments give the same result on every machine.
///
/// The whole mesh is held in memory, about 45 bytes per triangle. Throws Error if plan and cluster do not match, and
/// whatever refinement throws.
[[nodiscard]] ClusterRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs = {},
                                  const SimulationObservers& observers = {});

}  // namespace driftmesh
