#pragma once

#include <cstdint>
#include <functional>

#include "cluster/cluster_run.hpp"
#include "job/limits.hpp"
#include "job/prepare.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"

namespace driftmesh::job {

/// An observer of the triangles of all ranks together: shows progress, and throws LimitError if there are more than
/// `limits` allow. The arguments outlive it.
[[nodiscard]] std::function<void(std::int64_t triangles)> progress_within(const Limits& limits, double forecast,
                                                                          Watch& watch);

/// Makes the mesh on the simulated cluster of the request, in virtual time, at these costs. Adds what the ranks report
/// to `record`. Throws LimitError if all ranks together have more triangles than `limits` allow, and whatever simulate
/// throws.
[[nodiscard]] ClusterRun run_simulated(const Request& request, const Prepared& prepared, const Limits& limits,
                                       const CostModel& costs, RunRecord& record, Watch& watch);

}  // namespace driftmesh::job
