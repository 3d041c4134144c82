#pragma once

#include <map>
#include <memory>
#include <optional>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "balancer/effort.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// The council shared by all ranks of one process. What Zoltan takes for parts is noted as effort of all ranks alike, a
/// part of it for each, with the collective operations that it needs ("collective").
class SimulatedCouncil final : public Council {
 public:
  SimulatedCouncil(std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                   const ControllerOptions& options);

  [[nodiscard]] std::optional<Decision> decide(std::uint32_t round, const Contribution& contribution) override;

  /// Whether a rank has not decided in a round that another one has come to.
  [[nodiscard]] bool in_session() const { return !rounds_.empty(); }

 private:
  struct Round {
    std::map<Rank, Contribution> contributions;
    std::map<Rank, Decision> decisions;  // not yet fetched
    Efforts efforts;                     // of each rank
  };
  void conclude_round(Round& round) const;
  [[nodiscard]] std::vector<std::vector<Part>> parts_of(const std::vector<Contribution>& contributions,
                                                        const IdVector<Rank, RankLoad>& states) const;

  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;
  std::map<std::uint32_t, Round> rounds_;  // that are not over
};

/// The council of simulated ranks for plans of this policy; null if it does not plan collectively.
[[nodiscard]] std::unique_ptr<SimulatedCouncil> make_simulated_council(std::shared_ptr<const Layout> layout,
                                                                       std::shared_ptr<const Policy> policy,
                                                                       const ControllerOptions& options);

}  // namespace driftmesh::balancer
