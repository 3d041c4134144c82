#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "protocol/rules.hpp"
#include "runtime/subdomain_loop.hpp"
#include "sim/adversary_effects.hpp"
#include "sim/domains.hpp"
#include "sim/mover.hpp"
#include "sim/scenario.hpp"
#include "sim/stale_locations.hpp"
#include "sim/witness.hpp"
#include "support/adversarial_network.hpp"
#include "support/rules_over_tree.hpp"
#include "support/simulated_crew.hpp"

namespace driftmesh::sim {

/// The verdict of an oracle; empty if it found no problem.
struct Verdict {
  const char* oracle;
  std::string problem;
};

/// The outcome of a run.
struct Outcome {
  std::vector<Verdict> verdicts;  ///< in order; incomplete after a failure
  std::int64_t triangles = 0;
  std::uint64_t digest = 0;
  std::uint64_t steps = 0;
  protocol::ProtocolCounters counters;  ///< sums over all ranks
  protocol::AdversarialNetwork::Counters network;
  AdversaryEffects effects;
  std::int64_t asleep = 0;        ///< subdomains at the end
  std::int64_t shifts = 0;        ///< slices of work by crews
  std::uint64_t late_rounds = 0;  ///< probes after the one under way when all work was done
  bool digest_compared = false;

  /// The first problem, with the name of its oracle; empty if there is none.
  [[nodiscard]] std::string failure() const {
    for (const Verdict& v : verdicts)
      if (!v.problem.empty()) return std::string(v.oracle) + ": " + v.problem;
    return {};
  }
};

/// Real subdomains on ranks with the loop of a real run, on an adversarial network. During the run and at its end,
/// every oracle examines the actual state: the subdomains and the messages on the network, not the ranks' own counts.
class AdversarialRun {
 public:
  /// Inserts a layer between a rank and the network. It may access the rank's loop once the run has started.
  using Wrap =
      std::function<std::unique_ptr<protocol::Transport>(protocol::Transport&, std::function<const SubdomainLoop&()>)>;

  /// `scenario`, `domain` and `rules` must outlive the run. Broken rules test whether the oracles notice.
  AdversarialRun(const Scenario& scenario, Domain& domain, const Wrap& wrap = {},
                 const protocol::Rules& rules = protocol::sound_rules());

  Outcome run();

 private:
  struct Wrong {
    Verdict verdict;
  };
  void make_plan();
  void limit_memory();
  /// Time for policies: a step takes one unit, an insertion a tenth, or up to a whole one on a slow rank.
  [[nodiscard]] CostModel costs_of(Rank r) const;
  /// The scenario's adversary, with its mischief.
  protocol::Adversary adversary();
  protocol::Transport& transport_of(Rank r, const Wrap& wrap);
  [[nodiscard]] bool is_quiet() const { return quiet_since_.has_value(); }

  /// Runs to the end. False if the run does not end properly.
  bool go();
  protocol::StepResult step(Rank r);
  /// Checks that an arriving subdomain lives nowhere else.
  void watch_owners(Rank r);
  void watch_termination();
  [[nodiscard]] bool work_anywhere();
  void count();
  [[nodiscard]] std::string lost_messages() const;
  [[nodiscard]] std::string announcements(const std::vector<const Subdomain*>& all) const;
  [[nodiscard]] std::string owners_at_the_end() const;
  void compare_digest(const std::vector<const Subdomain*>& all);
  /// All subdomains; awake copies of those that sleep.
  [[nodiscard]] std::vector<const Subdomain*> subdomains_awake();
  [[nodiscard]] std::string describe() const;
  void say(const char* oracle, std::string problem) { outcome_.verdicts.push_back({oracle, std::move(problem)}); }

  const Scenario& scenario_;
  Domain& domain_;
  Mover mover_;
  RunPlan plan_;
  SubdomainContext context_;
  std::deque<Subdomain> copies_;
  protocol::AdversarialNetwork network_;
  testing::RulesOverTree rules_;
  StaleLocations stale_locations_;
  Witness witness_;
  std::vector<std::unique_ptr<protocol::Transport>> layers_;       // between ranks and network
  IdVector<Rank, std::unique_ptr<testing::SimulatedCrew>> crews_;  // if ranks have any
  IdVector<Rank, std::unique_ptr<SubdomainLoop>> loops_;
  IdVector<Rank, std::int64_t> arrivals_seen_;
  std::optional<std::uint64_t> quiet_since_;  // number of probes begun by then
  Outcome outcome_;
};

}  // namespace driftmesh::sim
