#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cluster/cluster_spec.hpp"
#include "migration/subdomain.hpp"
#include "protocol/rank_protocol.hpp"
#include "runtime/rank_times.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// What one rank had to do at one moment.
struct LoadSample {
  double time = 0;             ///< seconds since the run began
  protocol::Rank rank = 0;     ///< whose work changed at that time
  std::int64_t triangles = 0;  ///< that its subdomains have
  double remaining = 0;        ///< that they are expected to need still
  double worked = 0;           ///< seconds of refinement that ended at that time
};

/// A subdomain that went from one rank to another.
struct MoveRecord {
  protocol::SubdomainId subdomain = 0;
  protocol::Rank from = 0, to = 0;
  double left = 0, arrived = 0;  ///< seconds since the run began: packed and gone; unpacked
  std::uint64_t bytes = 0;       ///< its packed size
};

/// One rank at the end of a run.
struct RankOutcome {
  RankTimes times;
  protocol::ProtocolCounters counters;
  std::int64_t triangles = 0;
  std::int32_t subdomains = 0;
  std::int64_t interface_splits = 0;  ///< points that refinement put on interfaces
};

/// What a run on a simulated cluster came to.
struct SimulatedRun {
  double makespan = 0;  ///< seconds from the start to the moment when the last rank knows that all is done
  std::vector<RankOutcome> ranks;
  std::vector<MoveRecord> moves;          ///< in the order of leaving
  std::vector<LoadSample> samples;        ///< in the order of time
  std::vector<protocol::Rank> owners;     ///< of each subdomain at the end
  std::uint64_t messages = 0, bytes = 0;  ///< of all ranks, termination included
  std::uint64_t steps = 0;                ///< rounds of the ranks' loops
  [[nodiscard]] std::int64_t triangles() const;
};

/// What happens during the simulation; each may be empty.
struct SimulationObservers {
  std::function<void(std::int64_t triangles)> progress;      ///< of all ranks together, now and then
  std::function<void(const Subdomain& subdomain)> finished;  ///< each, once all is done
};

/// Runs `plan` on ranks that exist in this process alone. The meshes are made, and every message is sent, received and
/// decoded by the code of a real run; time alone is simulated: work passes by `costs` over the speed of the rank, and
/// messages by the cluster's network. The same arguments give the same result on every machine.
///
/// All of the mesh is held in memory, about 45 bytes a triangle. Throws Error if plan and cluster do not fit each
/// other, and what refinement throws.
[[nodiscard]] SimulatedRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs = {},
                                    const SimulationObservers& observers = {});

/// Seconds that the work of `run` would take if every rank computed from beginning to end: the sum of computing times
/// by speed over the sum of speeds.
[[nodiscard]] double ideal_seconds(const SimulatedRun& run, const std::vector<double>& speeds);

}  // namespace driftmesh
