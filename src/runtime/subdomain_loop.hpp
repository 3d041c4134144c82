#pragma once

#include <functional>
#include <map>
#include <memory>

#include "migration/subdomains.hpp"
#include "runtime/coupling.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// What the subdomains of a run have in common, on one rank. The plan must outlive it.
[[nodiscard]] SubdomainContext context_of(const RunPlan& plan);

/// The subdomains of a rank, and how they learn of each other. It exists before its loop does, and after it.
struct SubdomainsOnRank {
  /// Those that `plan`, which must outlive it, gives the rank at the start.
  SubdomainsOnRank(const RunPlan& plan, Rank rank);

  SubdomainContext context;
  Subdomains holding;
  std::unique_ptr<Coupling> coupling;
};

/// The loop of a rank that refines the subdomains of a plan.
class SubdomainLoop final : private SubdomainsOnRank, public RankLoop {
 public:
  /// Parameters as of RankLoop. `finished`: as in SubdomainContext.
  SubdomainLoop(protocol::Transport& transport, const RunPlan& plan, const CostModel& costs = {},
                Observers observers = {}, std::function<void(const Subdomain&)> finished = {},
                const protocol::Rules& rules = protocol::sound_rules());

  [[nodiscard]] const std::map<SubdomainId, Subdomain>& subdomains() const { return holding.all(); }
  /// The same, out of a loop that has ended.
  [[nodiscard]] std::map<SubdomainId, Subdomain> take_subdomains() { return holding.take(); }
};

}  // namespace driftmesh
