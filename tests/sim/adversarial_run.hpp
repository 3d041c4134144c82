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

#include "balancer/simulated/simulated_council.hpp"
#include "protocol/adversarial_network.hpp"
#include "protocol/rules.hpp"
#include "runtime/rank_loop.hpp"
#include "sim/deeds.hpp"
#include "sim/domains.hpp"
#include "sim/mover.hpp"
#include "sim/rumors.hpp"
#include "sim/scenario.hpp"
#include "sim/witness.hpp"

namespace driftmesh::sim {

/// What an oracle says; nothing if all is well.
struct Verdict {
  const char* oracle;
  std::string problem;
};

/// What a run came to.
struct Outcome {
  std::vector<Verdict> verdicts;  ///< in the order in which they were found; not all of them, after a failure
  std::int64_t triangles = 0;
  std::uint64_t digest = 0;
  std::uint64_t steps = 0;
  protocol::ProtocolCounters counters;  ///< of all ranks together
  protocol::AdversarialNetwork::Counters network;
  Deeds deeds;
  std::int64_t asleep = 0;        ///< subdomains at the end
  std::uint64_t late_rounds = 0;  ///< probes after the one that was out when all work was over
  bool digest_compared = false;

  /// The first problem with the name of its oracle, or nothing.
  [[nodiscard]] std::string failure() const {
    for (const Verdict& v : verdicts)
      if (!v.problem.empty()) return std::string(v.oracle) + ": " + v.problem;
    return {};
  }
};

/// Real subdomains on ranks with the loop of a real run, on a network that does its worst. While it runs, and at its
/// end, every oracle looks at the truth: at the subdomains and at what is on the network, not at anybody's counts.
class AdversarialRun {
 public:
  /// Puts something between a rank and the network. It may ask for the rank's loop once the run is going.
  using Wrap =
      std::function<std::unique_ptr<protocol::Transport>(protocol::Transport&, std::function<const RankLoop&()>)>;

  /// `scenario`, `domain` and `rules` must outlive the run. A broken rule of the protocol shows whether the oracles
  /// notice.
  AdversarialRun(const Scenario& scenario, Domain& domain, const Wrap& wrap = {},
                 const protocol::Rules& rules = protocol::sound_rules());

  Outcome run();

 private:
  struct Wrong {
    Verdict verdict;
  };
  void make_plan();
  /// Time for policies: a step takes one unit, an insertion a tenth, or up to a whole one on a slow rank.
  [[nodiscard]] CostModel costs_of(Rank r) const;
  /// The scenario's, with its mischief.
  protocol::Adversary adversary();
  protocol::Transport& transport_of(Rank r, const Wrap& wrap);
  [[nodiscard]] bool is_quiet() const { return quiet_since_.has_value(); }

  /// To the end of the run. False if it does not come to a good one.
  bool go();
  protocol::StepResult step(Rank r);
  /// A subdomain that arrives lives nowhere else.
  void watch_owners(Rank r);
  void watch_termination();
  [[nodiscard]] bool work_anywhere();
  void count();
  [[nodiscard]] std::string lost_messages() const;
  [[nodiscard]] std::string owners_at_the_end() const;
  void compare_digest(const std::vector<const Subdomain*>& all);
  /// All of them; of those that sleep, copies that are awake.
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
  Rumors rumors_;
  Witness witness_;
  std::vector<std::unique_ptr<protocol::Transport>> layers_;  // between ranks and network
  std::unique_ptr<balancer::SimulatedCouncil> council_;       // if the policy needs one
  IdVector<Rank, std::unique_ptr<RankLoop>> loops_;
  IdVector<Rank, std::int64_t> arrivals_seen_;
  std::optional<std::uint64_t> quiet_since_;  // probes that were out or over then
  Outcome outcome_;
};

}  // namespace driftmesh::sim
