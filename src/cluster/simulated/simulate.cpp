#include "cluster/simulated/simulate.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "base/key_error.hpp"
#include "cluster/rank_log.hpp"
#include "cluster/simulated/virtual_cluster.hpp"
#include "driftmesh/error.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/subdomain_loop.hpp"

namespace driftmesh {
namespace {

void require_fit(const LoopPlan& plan, std::int32_t ranks) {
  const auto most = std::max_element(plan.owners.begin(), plan.owners.end());
  if (most != plan.owners.end() && *most >= Rank{ranks})
    throw Error("the plan has work for rank " + to_string(*most) + ", but the cluster has " + std::to_string(ranks) +
                " ranks");
}

/// The ranks of one run, and their network.
class Simulation {
 public:
  Simulation(const LoopPlan& plan, const SimulatedWork& work, const ClusterSpec& cluster, const CostModel& costs,
             const std::function<void(std::int64_t)>& progress)
      : network_(virtual_cluster(cluster, costs)),
        cutting_(cutting_seconds(costs, plan.owners.size())),
        memory_(cluster.memory > 0 ? cluster.memory : balancer::kAmpleMemory),
        counted_(work.decomposition == nullptr),
        progress_(progress) {
    const std::int32_t ranks = ranks_of(cluster);
    const CostModel of_ranks = scaled(costs, cluster.scale);
    of_rank_.resize(to_index(ranks));
    logs_.reserve(to_index(ranks));  // the observers refer to its elements
    for (const Rank r : first_ids<Rank>(ranks)) {
      RankLog& log = logs_.emplace_back(network_.transport(r), work.decomposition);
      RankLoop::Observers watch;
      watch.after_slice = [this, r, &log](const RankLoop& loop, const RankLoop::Slice& slice) {
        log.worked(loop, slice, slice.seconds);
        count(r, loop.triangles());
      };
      watch.handed_over = [this, r, &log](const RankLoop& loop, const RankLoop::Passage& passage) {
        log.departs(loop, passage);
        count(r, loop.triangles());
      };
      watch.settled = [this, r, &log](const RankLoop& loop, const RankLoop::Passage& passage) {
        log.arrives(loop, passage);
        count(r, loop.triangles());
      };
      watch.deliberated = [&log](std::vector<balancer::Deliberation> considered) {
        log.deliberated(std::move(considered));
      };
      loops_.push_back(std::make_unique<RankLoop>(network_.transport(r), plan, *work.held[r], *work.coupling[r],
                                                  of_ranks, std::move(watch)));
      constexpr double kOffered = 0.9;  // as on real ranks: forecasts err
      if (memory_ < balancer::kAmpleMemory)
        loops_.back()->limit_memory(
            [this, r] { return kOffered * memory_ - static_cast<double>(loops_[r]->triangles()); });
      log.begins(*loops_.back());
    }
  }

  ClusterRun run() {
    IdVector<Rank, protocol::RankStep> steps;
    for (const auto& loop : loops_) steps.push_back([l = loop.get()] { return l->step(); });
    if (network_.run(steps).end != protocol::RunEnd::kFinished)
      throw Error("deadlock of the simulated ranks: " + describe());
    for (const Rank r : ids_of(loops_)) logs_[r].ends(*loops_[r]);
    ClusterRun joined = RankLog::join(logs_);
    joined.cutting = cutting_;
    return joined;
  }

 private:
  /// Reports the triangles of all ranks together, now that rank `r` has this many.
  void count(Rank r, std::int64_t triangles) {
    if (!counted_ && static_cast<double>(triangles) > memory_)
      throw Keyed<LimitError>(KeyText::of(
          "rank {} has more triangles than {cluster.memory} allows; allow more, or have more ranks", to_string(r)));
    triangles_ += triangles - std::exchange(of_rank_[r], triangles);
    if (progress_) progress_(triangles_);
  }

  [[nodiscard]] std::string describe() const {
    std::string text;
    for (const auto& loop : loops_)
      if (!loop->protocol().finished()) text += loop->protocol().describe() + "; ";
    return text;
  }

  protocol::VirtualNetwork network_;
  double cutting_;  // seconds, on rank 0
  double memory_;   // triangles that each rank has memory for
  bool counted_;    // work that is only counted may exceed memory_, since it includes the starts of subdomains
  const std::function<void(std::int64_t)>& progress_;
  IdVector<Rank, std::int64_t> of_rank_;  // triangles of each rank, as last reported
  std::int64_t triangles_ = 0;
  IdVector<Rank, RankLog> logs_;
  IdVector<Rank, std::unique_ptr<RankLoop>> loops_;
};

}  // namespace

ClusterRun simulate(const LoopPlan& plan, const SimulatedWork& work, const ClusterSpec& cluster, const CostModel& costs,
                    const std::function<void(std::int64_t)>& progress) {
  return Simulation(plan, work, cluster, costs, progress).run();
}

ClusterRun simulate(const RunPlan& plan, const ClusterSpec& cluster, const CostModel& costs,
                    const SimulationObservers& observers) {
  const std::int32_t ranks = ranks_of(cluster);
  require_fit(plan, ranks);
  std::deque<SubdomainsOnRank> subdomains;  // they stay where they are
  SimulatedWork work{.held = {}, .coupling = {}, .decomposition = &plan.decomposition};
  for (const Rank r : first_ids<Rank>(ranks)) {
    SubdomainsOnRank& of_rank = subdomains.emplace_back(plan, r);
    work.held.push_back(&of_rank.holding);
    work.coupling.push_back(of_rank.coupling.get());
  }
  ClusterRun run = simulate(plan, work, cluster, costs, observers.progress);
  if (!observers.finished) return run;
  for (const Rank r : ids_of(run.ranks)) observers.finished(run.ranks[r], subdomains[to_index(r)].holding.all());
  return run;
}

}  // namespace driftmesh
