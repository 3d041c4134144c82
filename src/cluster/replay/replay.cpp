#include "cluster/replay/replay.hpp"

#include "cluster/simulated/simulate.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {
namespace {

LoopPlan plan_of(const RecordedRun& run, const std::shared_ptr<const balancer::Policy>& policy) {
  LoopPlan plan;
  for (const auto& s : run.layout->subdomains) plan.owners.push_back(s.owner);
  plan.work.slice = run.slice;
  plan.work.order = run.order;
  plan.balancing.options = run.options;
  plan.balancing.options.work_to_start = 0;  // it is counted with the rest
  if (policy->placement() == balancer::Placement::kNobody) return plan;
  plan.layout = run.layout;
  plan.policy = policy;
  return plan;
}

}  // namespace

ReplayedRun replay(const RecordedRun& run, const std::shared_ptr<const balancer::Policy>& policy) {
  const CostModel costs;
  const double triangle = 1 / reference_speed(scaled(costs, run.cluster.scale));
  IdVector<Rank, CountedHolding> held(to_index(ranks_of(run.cluster)), CountedHolding(triangle));
  for (const SubdomainId s : ids_of(run.work)) held[(*run.layout)[s].owner].add(s, run.work[s]);
  NoCoupling coupling;
  SimulatedWork work;
  for (CountedHolding& of_rank : held) work.held.push_back(&of_rank);
  work.coupling.assign(held.size(), &coupling);
  const ClusterRun replayed = simulate(plan_of(run, policy), work, run.cluster, costs);
  return {replayed.makespan, replayed.moves.size()};
}

}  // namespace driftmesh
