#pragma once

#include <map>
#include <memory>
#include <unordered_set>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// The council shared by all ranks of one process. Nobody waits: decisions follow from the loads announced.
class SimulatedCouncil final : public Council {
 public:
  SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                   const ControllerOptions& options);

  void announce(std::uint32_t round, const Contribution& contribution) override;
  [[nodiscard]] Decision decide(std::uint32_t round, const Contribution& contribution) override;

  /// Whether rank 0, which calls the rounds, has not decided in a round that was started. Other ranks may have learned
  /// of its start too late, after the end of all work or the call to the next round; real ranks would be waited for.
  [[nodiscard]] bool in_session() const;

 private:
  struct Round {
    std::map<Rank, Contribution> contributions;
    std::unordered_set<SubdomainId> listed;
    std::map<Rank, Decision> decisions;  // not yet fetched
    bool decided = false;
  };
  void conclude_round(Round& round) const;
  [[nodiscard]] std::vector<std::vector<Part>> parts_of(const std::vector<Contribution>& contributions,
                                                        const IdVector<Rank, RankLoad>& states) const;

  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;
  std::map<std::uint32_t, Round> rounds_;
  std::uint32_t last_ = 0;
};

/// The council of simulated ranks for plans of this policy; null if it does not plan collectively.
[[nodiscard]] std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                                       std::shared_ptr<const Policy> policy,
                                                                       const ControllerOptions& options);

}  // namespace driftmesh::balancer
