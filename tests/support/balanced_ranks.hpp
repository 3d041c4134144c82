#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "cluster/replay/working_rank.hpp"
#include "protocol/virtual_network.hpp"
#include "support/load_snapshots.hpp"

namespace driftmesh::testing {

using Job = CountedWork;
using Jobs = IdVector<SubdomainId, Job>;

struct Cluster {
  IdVector<Rank, double> speeds;  // triangles a second
  double latency = 50e-6;
  double bandwidth = 1e9;
  double slice = 16384;
};

struct Outcome {
  double time = 0;   // when the last work was done
  double ideal = 0;  // total work over total speed
  int moves = 0;
  int most_moves_of_one = 0;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  bool complete = false;  // the run ended properly, and every job was done completely and once
};

/// For adversarial networks, where time is the number of steps, and speed is in jobs per step.
inline balancer::ControllerOptions options_in_steps() {
  balancer::ControllerOptions options;
  options.look = 3;
  options.gap = 20;
  options.interval = 300;
  options.cost.latency = 1;
  return options;
}

/// The ranks of one run, made for the endpoints of a network.
class WorkingRanks {
 public:
  template <class Network>
  WorkingRanks(Network& network, const balancer::Layout& layout, const Jobs& jobs, const std::string& policy,
               const balancer::Parameters::Values& parameters, const balancer::ControllerOptions& options, double slice,
               double given_speed = 0, const IdVector<Rank, double>& memory = {})
      : jobs_(jobs) {
    const auto shared_layout = std::make_shared<const balancer::Layout>(layout);
    const std::shared_ptr<const balancer::Policy> shared_policy = balancer::make_policy(policy, parameters);
    for (const Rank r : first_ids<Rank>(layout.ranks)) {
      WorkingRank::Options own{.slice = slice, .given_speed = given_speed};
      if (!memory.empty()) own.memory = memory[r];
      ranks_.push_back(
          std::make_unique<WorkingRank>(network.transport(r), shared_layout, jobs, shared_policy, options, own));
      steps_.emplace_back([rank = ranks_.back().get()] { return rank->step(); });
    }
  }
  [[nodiscard]] const IdVector<Rank, protocol::RankStep>& steps() const { return steps_; }
  [[nodiscard]] const WorkingRank& operator[](Rank r) const { return *ranks_[r]; }

  /// Determined from the jobs, wherever they are.
  [[nodiscard]] Outcome outcome(protocol::RunEnd end) const {
    Outcome outcome;
    outcome.complete = end == protocol::RunEnd::kFinished;
    IdVector<SubdomainId, int> found(jobs_.size(), 0);
    std::map<SubdomainId, int> moves_of;
    for (const auto& rank : ranks_) {
      outcome.time = std::max(outcome.time, rank->last_work);
      outcome.moves += rank->counts().moves;
      for (const auto& [id, n] : rank->counts().moves_of) moves_of[id] += n;
      for (const auto& [id, job] : rank->jobs()) {
        ++found[id];
        if (job.done != jobs_[id].work) outcome.complete = false;
      }
    }
    for (const auto& [id, n] : moves_of) outcome.most_moves_of_one = std::max(outcome.most_moves_of_one, n);
    outcome.complete = outcome.complete && std::all_of(found.begin(), found.end(), [](int n) { return n == 1; });
    return outcome;
  }

 private:
  const Jobs& jobs_;
  IdVector<Rank, std::unique_ptr<WorkingRank>> ranks_;
  IdVector<Rank, protocol::RankStep> steps_;
};

/// Runs jobs on simulated ranks in virtual time until the protocol terminates.
inline Outcome run_jobs(const Cluster& cluster, const balancer::Layout& layout, const Jobs& jobs,
                        const std::string& policy, const balancer::Parameters::Values& parameters = {},
                        const balancer::ControllerOptions& options = {}) {
  protocol::VirtualNetwork network({cluster.speeds,
                                    [&](Rank, Rank) {
                                      return protocol::Link{cluster.latency, cluster.bandwidth};
                                    },
                                    1e-6, 1e-6, 50'000'000});
  WorkingRanks ranks(network, layout, jobs, policy, parameters, options, cluster.slice);
  Outcome outcome = ranks.outcome(network.run(ranks.steps()).end);
  double work = 0, speed = 0;
  for (const Job& job : jobs) work += job.work;
  for (const double s : cluster.speeds) speed += s;
  outcome.ideal = work / speed;
  outcome.messages = network.messages();
  outcome.bytes = network.bytes();
  return outcome;
}

}  // namespace driftmesh::testing
