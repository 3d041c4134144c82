#include "runtime/subdomain_loop.hpp"

#include <utility>

namespace driftmesh {

SubdomainContext context_of(const RunPlan& plan) {
  return {.decomposition = &plan.decomposition,
          .bounds = plan.bounds,
          .presplit = plan.presplit,
          .scratch = plan.scratch,
          .presplit_paths = plan.presplit_paths.get(),
          .beginnings = plan.beginnings,
          .sleep = plan.work.sleep};
}

SubdomainsOnRank::SubdomainsOnRank(const RunPlan& plan, Rank rank)
    : context(context_of(plan)), holding(context), coupling(coupling_of(plan)) {
  for (const SubdomainId s : ids_of(plan.owners))
    if (plan.owners[s] == rank) holding.make(s);
}

SubdomainLoop::SubdomainLoop(protocol::Transport& transport, const RunPlan& plan, const CostModel& costs,
                             Observers observers, std::function<void(const Subdomain&)> finished,
                             const protocol::Rules& rules)
    : SubdomainsOnRank(plan, transport.rank()),
      RankLoop(transport, plan, holding, *coupling, costs, std::move(observers), rules) {
  context.finished = std::move(finished);
}

}  // namespace driftmesh
