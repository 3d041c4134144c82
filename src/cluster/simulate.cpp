#include "cluster/simulate.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh {
namespace {

using protocol::Rank;

protocol::VirtualCluster virtual_cluster(const ClusterSpec& cluster, const CostModel& costs) {
  protocol::VirtualCluster made;
  made.speeds = speeds_of(cluster, costs);
  for (double& speed : made.speeds) speed /= reference_speed(costs);
  const protocol::Link link{cluster.latency, cluster.bandwidth};
  made.link = [link](Rank, Rank) { return link; };
  made.message_overhead = cluster.message_overhead;
  return made;
}

void require_fit(const RunPlan& plan, std::size_t ranks) {
  const auto most = std::max_element(plan.owners.begin(), plan.owners.end());
  if (most != plan.owners.end() && *most >= static_cast<Rank>(ranks))
    throw Error("the plan has work for rank " + std::to_string(*most) + ", but the cluster has " +
                std::to_string(ranks) + " ranks");
}

double remaining_on(const RankLoop& loop) {
  double remaining = 0;
  for (const auto& [id, subdomain] : loop.subdomains()) remaining += subdomain.remaining();
  return remaining;
}

/// The ranks of one run with their network.
class Simulation {
 public:
  Simulation(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs,
             const SimulationObservers& observers)
      : network_(virtual_cluster(cluster, costs)), observers_(observers) {
    const auto ranks = static_cast<Rank>(ranks_of(cluster));
    require_fit(plan, static_cast<std::size_t>(ranks));
    of_rank_.resize(static_cast<std::size_t>(ranks));
    for (Rank r = 0; r < ranks; ++r) {
      RankLoop::Observers watch;
      watch.after_slice = [this, r](const RankLoop&, double seconds) { sample(r, seconds); };
      watch.handed_over = [this, r](SubdomainId id, Rank to, std::size_t bytes) { departs(id, r, to, bytes); };
      watch.settled = [this, r](SubdomainId id) { arrives(id, r); };
      loops_.push_back(std::make_unique<RankLoop>(network_.transport(r), plan, costs, std::move(watch)));
      sample(r, 0);
    }
  }

  SimulatedRun run(const RunPlan& plan) {
    std::vector<protocol::RankStep> steps;
    for (const auto& loop : loops_) steps.push_back([l = loop.get()] { return l->step(); });
    const protocol::RunResult result = network_.run(steps);
    if (result.end != protocol::RunEnd::kFinished)
      throw Error("the simulated ranks wait for each other: " + describe());
    run_.steps = result.steps;
    conclude(plan);
    return std::move(run_);
  }

 private:
  void departs(SubdomainId id, Rank from, Rank to, std::size_t bytes) {
    under_way_[id] = run_.moves.size();
    run_.moves.push_back({id, from, to, network_.clock(from), 0, bytes});
    sample(from, 0);
  }

  void arrives(SubdomainId id, Rank rank) {
    run_.moves[under_way_.at(id)].arrived = network_.clock(rank);
    sample(rank, 0);
  }

  void sample(Rank rank, double worked) {
    const RankLoop& loop = *loops_[static_cast<std::size_t>(rank)];
    triangles_ += loop.triangles() - std::exchange(of_rank_[static_cast<std::size_t>(rank)], loop.triangles());
    run_.samples.push_back({network_.clock(rank), rank, loop.triangles(), remaining_on(loop), worked});
    if (observers_.progress) observers_.progress(triangles_);
  }

  void conclude(const RunPlan& plan) {
    run_.makespan = network_.makespan();
    run_.messages = network_.messages();
    run_.bytes = network_.bytes();
    run_.owners.resize(plan.owners.size());
    for (std::size_t r = 0; r < loops_.size(); ++r) {
      const RankLoop& loop = *loops_[r];
      run_.ranks.push_back({loop.times(), loop.protocol().counters(), loop.triangles(),
                            static_cast<std::int32_t>(loop.subdomains().size()), loop.interface_splits()});
      for (const auto& [id, subdomain] : loop.subdomains()) {
        run_.owners[static_cast<std::size_t>(id)] = static_cast<Rank>(r);
        if (observers_.finished) observers_.finished(subdomain);
      }
    }
    std::stable_sort(run_.moves.begin(), run_.moves.end(),
                     [](const MoveRecord& a, const MoveRecord& b) { return a.left < b.left; });
    std::stable_sort(run_.samples.begin(), run_.samples.end(),
                     [](const LoadSample& a, const LoadSample& b) { return a.time < b.time; });
  }

  [[nodiscard]] std::string describe() const {
    std::string text;
    for (const auto& loop : loops_)
      if (!loop->protocol().finished()) text += loop->protocol().describe() + "; ";
    return text;
  }

  protocol::VirtualNetwork network_;
  const SimulationObservers& observers_;
  SimulatedRun run_;
  std::vector<std::int64_t> of_rank_;  // triangles of each
  std::int64_t triangles_ = 0;
  std::map<SubdomainId, std::size_t> under_way_;  // the last move of each that has moved
  std::vector<std::unique_ptr<RankLoop>> loops_;
};

}  // namespace

std::int64_t SimulatedRun::triangles() const {
  return std::accumulate(ranks.begin(), ranks.end(), std::int64_t{0},
                         [](std::int64_t sum, const RankOutcome& rank) { return sum + rank.triangles; });
}

SimulatedRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs,
                      const SimulationObservers& observers) {
  return Simulation(plan, cluster, costs, observers).run(plan);
}

double ideal_seconds(const SimulatedRun& run, const std::vector<double>& speeds) {
  double work = 0;
  for (std::size_t r = 0; r < run.ranks.size(); ++r) work += run.ranks[r].times.computing * speeds[r];
  return work / std::accumulate(speeds.begin(), speeds.end(), 0.0);
}

}  // namespace driftmesh
