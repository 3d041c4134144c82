#include "job/simulated/simulated_ranks.hpp"

#include "base/key_error.hpp"
#include "cluster/simulated/simulate.hpp"
#include "driftmesh/error.hpp"
#include "job/domain.hpp"
#include "job/memory.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::job {

std::unique_ptr<Refined> SimulatedRanks::refine(Order&& order, const Limits& limits, const SizeField*, Watch& watch) {
  RunPlan plan = std::move(order.plan);
  plan.bounds.size = order.size.get();
  plan.bounds.step = order.step.get();
  std::vector<RankReport> reports;
  FactsBook book(plan.decomposition);
  SimulationObservers observers;
  observers.progress = progress_within(limits, forecast_of(plan), watch);
  observers.finished = [&](const RankOutcome& rank, const std::map<SubdomainId, Subdomain>& subdomains) {
    reports.push_back(report_of(rank, subdomains, plan, book));
  };
  ClusterRun history = simulate(plan, cluster_, costs_, observers);
  plan.bounds.size = nullptr;
  plan.bounds.step = nullptr;
  return std::make_unique<SimulatedOutcome>(std::move(reports), std::move(history), std::move(plan));
}

void SimulatedOutcome::report(RunRecord& record) {
  for (const RankReport& rank : reports_) add_report(record, rank);
  add_plan(record, plan_);
  record.peak = record.peak_refining = peak_memory();
}

std::function<void(std::int64_t)> progress_within(const Limits& limits, double forecast, Watch& watch) {
  return [&limits, forecast, &watch](std::int64_t triangles) {
    const bool by_memory = memory_is_full(limits, triangles);
    if (by_memory || triangles > limits.triangles)
      throw Keyed<LimitError>(KeyText::of("{}. No mesh was made", stopped_message(limits, by_memory, triangles, true)));
    watch.refining(triangles, forecast);
  };
}

}  // namespace driftmesh::job
