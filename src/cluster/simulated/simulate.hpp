#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "cluster/cluster_run.hpp"
#include "cluster/cluster_spec.hpp"
#include "migration/subdomain.hpp"
#include "migration/work.hpp"
#include "runtime/coupling.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Callbacks during the simulation; each may be empty.
struct SimulationObservers {
  std::function<void(std::int64_t triangles)> progress;  ///< called from time to time with the sum over all ranks
  /// Each rank, in order, once all are done, with the subdomains that it holds.
  std::function<void(const RankOutcome&, const std::map<SubdomainId, Subdomain>&)> finished;
};

/// Runs `plan` on simulated ranks within this process. The meshes are really made, and every message is sent, received
/// and decoded by the code of a real run; only time is simulated: work takes `costs` divided by the speed of the rank,
/// and messages take what the cluster's network takes. The same arguments give the same result on every machine.
///
/// The whole mesh is held in memory, about 45 bytes per triangle. Throws Error if plan and cluster do not match, and
/// whatever refinement throws.
[[nodiscard]] ClusterRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs = {},
                                  const SimulationObservers& observers = {});

/// Work of any kind at the start of a simulation.
struct SimulatedWork {
  IdVector<Rank, Holding*> held;                 ///< on each rank, as the plan says
  IdVector<Rank, Coupling*> coupling;            ///< that each rank goes by
  const Decomposition* decomposition = nullptr;  ///< its borders; null if it has none
};

/// The same for `work`, with which its ranks end. `progress` may be empty.
[[nodiscard]] ClusterRun simulate(const LoopPlan& plan, const SimulatedWork& work, const ClusterSpec& cluster,
                                  const CostModel& costs,
                                  const std::function<void(std::int64_t triangles)>& progress = {});

}  // namespace driftmesh
