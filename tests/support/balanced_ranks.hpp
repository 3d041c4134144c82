#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "balancer/codec.hpp"
#include "balancer/controller.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "balancer/simulated/simulated_council.hpp"
#include "balancer/speed_estimate.hpp"
#include "protocol/codec.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/virtual_network.hpp"
#include "support/load_snapshots.hpp"
#include "support/policy_called.hpp"

namespace driftmesh::testing {

/// Work that a rank can do step by step and hand over: all that balancing sees of a subdomain.
struct Job {
  double done = 0;      // triangles
  double work = 0;      // the actual amount
  double forecast = 0;  // what all ranks believe
  [[nodiscard]] double remaining() const { return done >= work ? 0 : std::max(1.0, forecast - done); }
  [[nodiscard]] std::uint64_t bytes() const { return 40 + static_cast<std::uint64_t>(16 * done); }
};

using Jobs = IdVector<SubdomainId, Job>;

/// A rank that does its jobs one after the other, with the real protocol, codec and controller.
class WorkingRank {
 public:
  struct Counts {
    int moves = 0;
    std::map<SubdomainId, int> moves_of;
    double done = 0;
  };

  WorkingRank(protocol::Transport& transport, std::shared_ptr<const balancer::Layout> layout, const Jobs& jobs,
              std::shared_ptr<const balancer::Policy> policy, const balancer::ControllerOptions& options,
              balancer::Council* council, double slice, double given_speed = 0)
      : transport_(transport),
        protocol_(transport.rank(), transport.ranks(), owners_of(*layout)),
        limits_{transport.ranks(), static_cast<std::int32_t>(jobs.size()), 1},
        controller_(transport.rank(), layout, std::move(policy), options, transport.now(), council),
        slice_(slice),
        given_speed_(given_speed) {
    for (const SubdomainId i : ids_of(jobs))
      if ((*layout)[i].owner == transport.rank()) jobs_[i] = jobs[i];
  }

  protocol::StepResult step() {
    const bool heard = poll();
    const bool ran_out = std::exchange(worked_, false) && agenda().empty();
    if (ran_out || controller_.due(transport_.now())) balance();
    send();
    const bool worked = worked_ = work();
    if (!worked) protocol_.rest(!controller_.waiting());
    send();
    if (protocol_.finished()) return protocol::StepResult::kFinished;
    return heard || worked ? protocol::StepResult::kBusy : protocol::StepResult::kIdle;
  }

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const std::map<SubdomainId, Job>& jobs() const { return jobs_; }
  double last_work = 0;  // the time when it last had something to do

 private:
  static IdVector<SubdomainId, Rank> owners_of(const balancer::Layout& layout) {
    IdVector<SubdomainId, Rank> owners;
    for (const auto& s : layout.subdomains) owners.push_back(s.owner);
    return owners;
  }

  void send() {
    for (const auto& o : protocol_.take_outgoing()) transport_.send(o.destination, protocol::encode(o.message));
  }

  bool poll() {
    bool heard = false;
    while (const auto received = transport_.poll()) {
      heard = true;
      auto delivery = protocol_.receive(received->source, protocol::decode(received->source, received->bytes, limits_));
      if (delivery.arrival) {
        Job job;
        std::memcpy(&job, delivery.arrival->packed.data(), sizeof job);
        jobs_[delivery.arrival->subdomain] = job;
        controller_.arrived(delivery.arrival->subdomain, delivery.arrival->epoch, transport_.now());
      }
      if (delivery.advice)
        controller_.receive(received->source, balancer::decode(received->source, *delivery.advice, limits_),
                            transport_.now());
    }
    return heard;
  }

  // Jobs already begun come first, as in the loop of a real rank.
  [[nodiscard]] std::vector<SubdomainId> agenda() const {
    std::vector<SubdomainId> order;
    for (const auto& [id, job] : jobs_)
      if (job.remaining() > 0) order.push_back(id);
    std::stable_partition(order.begin(), order.end(), [&](SubdomainId id) { return jobs_.at(id).done > 0; });
    return order;
  }

  void balance() {
    std::vector<balancer::ReportedLoad> own;
    for (const SubdomainId id : agenda())
      own.push_back({id, protocol_.where(id).epoch, jobs_.at(id).remaining(), jobs_.at(id).bytes()});
    auto decision = controller_.think(transport_.now(), own, given_speed_ > 0 ? given_speed_ : speed_.value());
    if (decision.planned) controller_.took(1e-3);
    for (auto& message : decision.messages) protocol_.advise(message.destination, balancer::encode(message.message));
    for (const auto& move : decision.moves) hand_over(move);
  }

  void hand_over(const balancer::Move& move) {
    const auto node = jobs_.extract(move.subdomain);
    Bytes packed(std::max<std::size_t>(sizeof(Job), node.mapped().bytes()));
    std::memcpy(packed.data(), &node.mapped(), sizeof(Job));
    protocol_.hand_off(move.subdomain, move.destination, std::move(packed));
    ++counts_.moves;
    ++counts_.moves_of[move.subdomain];
  }

  bool work() {
    const auto order = agenda();
    if (order.empty()) return false;
    Job& job = jobs_.at(order.front());
    const double amount = std::min(slice_, job.work - job.done);
    const double before = transport_.now();
    transport_.spend(amount);  // speeds of the network are triangles a second
    job.done += amount;
    counts_.done += amount;
    speed_.add({amount, transport_.now() - before});
    last_work = transport_.now();
    return true;
  }

  protocol::Transport& transport_;
  protocol::RankProtocol protocol_;
  protocol::WireLimits limits_;
  balancer::Controller controller_;
  balancer::SpeedEstimate speed_;
  std::map<SubdomainId, Job> jobs_;
  double slice_;
  bool worked_ = false;  // in the last step
  double given_speed_;   // where there is no time to measure one
  Counts counts_;
};

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

/// The ranks of one run, made for the endpoints of a network.
class WorkingRanks {
 public:
  template <class Network>
  WorkingRanks(Network& network, const balancer::Layout& layout, const Jobs& jobs, const std::string& policy,
               const balancer::Parameters::Values& parameters, const balancer::ControllerOptions& options, double slice,
               double given_speed = 0)
      : jobs_(jobs) {
    const auto shared_layout = std::make_shared<const balancer::Layout>(layout);
    PolicyCalled called = policy_called(policy);
    called.parameters.insert(parameters.begin(), parameters.end());
    const std::shared_ptr<const balancer::Policy> shared_policy = balancer::make_policy(called.name, called.parameters);
    council_ = balancer::make_simulated_council(shared_layout, shared_policy, options);
    for (const Rank r : first_ids<Rank>(layout.ranks)) {
      ranks_.push_back(std::make_unique<WorkingRank>(network.transport(r), shared_layout, jobs, shared_policy, options,
                                                     council_.get(), slice, given_speed));
      steps_.emplace_back([rank = ranks_.back().get()] { return rank->step(); });
    }
  }
  [[nodiscard]] const IdVector<Rank, protocol::RankStep>& steps() const { return steps_; }

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
  std::unique_ptr<balancer::Council> council_;  // if the policy needs one
  std::vector<std::unique_ptr<WorkingRank>> ranks_;
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
