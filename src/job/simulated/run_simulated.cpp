#include "job/simulated/run_simulated.hpp"

#include "cluster/simulated/simulate.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"

namespace driftmesh::job {

std::function<void(std::int64_t)> progress_within(const Limits& limits, double forecast, Watch& watch) {
  return [&limits, forecast, &watch](std::int64_t triangles) {
    const bool by_memory = memory_is_full(limits, triangles);
    if (by_memory || triangles > limits.triangles)
      throw LimitError(stopped_message(limits, by_memory, triangles, true) + ". No mesh was made");
    watch.refining(triangles, forecast);
  };
}

ClusterRun run_simulated(const Request& request, const Prepared& prepared, const Limits& limits, const CostModel& costs,
                         RunRecord& record, Watch& watch) {
  SimulationObservers observers;
  observers.progress = progress_within(limits, prepared.forecast, watch);
  FactsBook book(prepared.plan.decomposition);
  observers.finished = [&](const RankLoop& rank) { add_report(record, report_of(rank, prepared.plan, book)); };
  ClusterRun outcome = simulate(prepared.plan, cluster_of(request), costs, observers);
  add_plan(record, prepared.plan);
  record.peak = record.peak_refining = peak_memory();
  return outcome;
}

}  // namespace driftmesh::job
