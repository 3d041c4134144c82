#pragma once

#include <map>
#include <memory>
#include <unordered_set>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// The council of ranks that live in one process, all of which share it. Nobody waits: what is decided follows from
/// what they had to do when they announced themselves.
class SimulatedCouncil final : public Council {
 public:
  SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                   const ControllerOptions& options);

  void announce(std::uint32_t round, const Contribution& contribution) override;
  [[nodiscard]] Decision decide(std::uint32_t round, const Contribution& contribution) override;

  /// Whether a round was begun that rank 0, which calls all together, has not decided in. Others may have heard of its
  /// start too late, after the end of all work or the call to the next round; real ranks would be waited for.
  [[nodiscard]] bool in_session() const;

 private:
  struct Round {
    std::map<Rank, Contribution> contributions;
    std::unordered_set<SubdomainId> listed;
    std::map<Rank, Decision> decisions;  // not fetched yet
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

/// What simulated ranks need for plans of this policy: null if it does not make all of them plan together.
[[nodiscard]] std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                                       std::shared_ptr<const Policy> policy,
                                                                       const ControllerOptions& options);

}  // namespace driftmesh::balancer
