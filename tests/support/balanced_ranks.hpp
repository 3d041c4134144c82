#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "cluster/cluster_spec.hpp"
#include "cluster/replay/counted_work.hpp"
#include "cluster/simulated/virtual_cluster.hpp"
#include "protocol/transport_layer.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/rank_loop.hpp"
#include "support/load_snapshots.hpp"

namespace driftmesh::testing {

using Job = Count;
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

/// For adversarial networks, where time is the number of steps.
inline balancer::ControllerOptions options_in_steps() {
  balancer::ControllerOptions options;
  options.look = 3;
  options.gap = 20;
  options.interval = 300;
  options.cost.latency = 1;
  return options;
}

/// Ranks of a network without a clock of its own, for which time passes while they work.
template <class Network>
class TimedNetwork {
 public:
  TimedNetwork(Network& network, std::int32_t ranks) : network_(network) {
    for (const Rank r : first_ids<Rank>(ranks)) transports_.push_back(std::make_unique<Timed>(network.transport(r)));
  }
  protocol::Transport& transport(Rank r) { return *transports_[r]; }
  protocol::RunResult run(const IdVector<Rank, protocol::RankStep>& steps) { return network_.run(steps); }

 private:
  class Timed final : public protocol::TransportLayer {
   public:
    using TransportLayer::TransportLayer;
    [[nodiscard]] double now() const override { return TransportLayer::now() + spent_; }
    void spend(double seconds) override { spent_ += seconds; }

   private:
    double spent_ = 0;
  };

  Network& network_;
  IdVector<Rank, std::unique_ptr<Timed>> transports_;
};

/// How ranks do their jobs.
struct Working {
  double slice = 16384;                       // triangles at most
  double triangle = 1 / reference_speed({});  // seconds on the reference machine
  IdVector<Rank, double> memory{};            // triangles
};

/// The ranks of one run, made for the endpoints of a network: the loops of real ranks, on counted work.
class WorkingRanks {
 public:
  template <class Network>
  WorkingRanks(Network& network, const balancer::Layout& layout, const Jobs& jobs, const std::string& policy,
               const balancer::Parameters::Values& parameters, const balancer::ControllerOptions& options,
               const Working& working)
      : jobs_(jobs) {
    for (const auto& s : layout.subdomains) plan_.owners.push_back(s.owner);
    plan_.work.slice = std::max<std::int64_t>(1, static_cast<std::int64_t>(working.slice / kTrianglesPerPoint));
    plan_.balancing.options = options;
    plan_.balancing.options.work_to_start = 0;
    if (auto made = balancer::make_policy(policy, parameters); made->placement() != balancer::Placement::kNobody) {
      plan_.layout = std::make_shared<const balancer::Layout>(layout);
      plan_.policy = std::move(made);
    }
    for (const Rank r : first_ids<Rank>(layout.ranks)) {
      ranks_.push_back(std::make_unique<OneRank>(network.transport(r), plan_, r, jobs, working.triangle));
      if (!working.memory.empty()) ranks_.back()->limit_memory(working.memory[r]);
      steps_.emplace_back([rank = ranks_.back().get()] { return rank->step(); });
    }
  }
  [[nodiscard]] const IdVector<Rank, protocol::RankStep>& steps() const { return steps_; }
  /// Triangles of a rank's jobs when all are done, by their forecasts.
  [[nodiscard]] double occupied(Rank r) const {
    double triangles = 0;
    for (const auto& [id, job] : ranks_[r]->jobs()) triangles += std::max(job.count().done, job.count().forecast);
    return triangles;
  }

  /// Determined from the jobs, wherever they are.
  [[nodiscard]] Outcome outcome(protocol::RunEnd end) const {
    Outcome outcome;
    outcome.complete = end == protocol::RunEnd::kFinished;
    IdVector<SubdomainId, int> found(jobs_.size(), 0);
    std::map<SubdomainId, int> moves_of;
    for (const auto& rank : ranks_) {
      outcome.time = std::max(outcome.time, rank->last_work());
      for (const auto& [id, n] : rank->moves_of()) {
        moves_of[id] += n;
        outcome.moves += n;
      }
      for (const auto& [id, job] : rank->jobs()) {
        ++found[id];
        if (job.count().done != jobs_[id].work) outcome.complete = false;
      }
    }
    for (const auto& [id, n] : moves_of) outcome.most_moves_of_one = std::max(outcome.most_moves_of_one, n);
    outcome.complete = outcome.complete && std::all_of(found.begin(), found.end(), [](int n) { return n == 1; });
    return outcome;
  }

 private:
  class OneRank {
   public:
    OneRank(protocol::Transport& transport, const LoopPlan& plan, Rank rank, const Jobs& jobs, double triangle)
        : held_(triangle) {
      for (const SubdomainId s : ids_of(jobs))
        if (plan.owners[s] == rank) held_.add(s, jobs[s]);
      RankLoop::Observers observers;
      observers.after_slice = [&](const RankLoop&, const RankLoop::Slice&) { last_work_ = transport.now(); };
      observers.handed_over = [this](const RankLoop&, const RankLoop::Passage& moved) { ++moves_of_[moved.subdomain]; };
      loop_.emplace(transport, plan, held_, coupling_, CostModel{}, std::move(observers));
    }
    void limit_memory(double triangles) {
      if (triangles < balancer::kAmpleMemory)
        loop_->limit_memory([this, triangles] { return triangles - static_cast<double>(loop_->triangles()); });
    }
    protocol::StepResult step() { return loop_->step(); }

    [[nodiscard]] const std::map<SubdomainId, CountedWork>& jobs() const { return held_.all(); }
    [[nodiscard]] double last_work() const { return last_work_; }
    [[nodiscard]] const std::map<SubdomainId, int>& moves_of() const { return moves_of_; }

   private:
    CountedHolding held_;
    NoCoupling coupling_;
    double last_work_ = 0;
    std::map<SubdomainId, int> moves_of_;
    std::optional<RankLoop> loop_;
  };

  const Jobs& jobs_;
  LoopPlan plan_;
  IdVector<Rank, std::unique_ptr<OneRank>> ranks_;
  IdVector<Rank, protocol::RankStep> steps_;
};

/// Runs jobs on simulated ranks in virtual time until the protocol terminates.
inline Outcome run_jobs(const Cluster& cluster, const balancer::Layout& layout, const Jobs& jobs,
                        const std::string& policy, const balancer::Parameters::Values& parameters = {},
                        const balancer::ControllerOptions& options = {}) {
  ClusterSpec spec;
  spec.latency = cluster.latency;
  spec.bandwidth = cluster.bandwidth;
  for (const double speed : cluster.speeds) spec.groups.push_back({"", 1, speed});
  protocol::VirtualCluster made = virtual_cluster(spec, {});
  made.step_limit = 50'000'000;
  protocol::VirtualNetwork network(std::move(made));
  WorkingRanks ranks(network, layout, jobs, policy, parameters, options, {.slice = cluster.slice});
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
