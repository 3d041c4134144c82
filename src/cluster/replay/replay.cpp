#include "cluster/replay/replay.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/error.hpp"
#include "protocol/virtual_network.hpp"

namespace driftmesh {

ReplayedRun replay(const RecordedRun& run, const std::shared_ptr<const balancer::Policy>& policy) {
  protocol::VirtualCluster cluster{
      .speeds = run.speeds,
      .link = [link = protocol::Link{run.latency, run.bandwidth}](Rank, Rank) { return link; },
      .message_overhead = run.message_overhead};
  cluster.schedules = run.schedules;
  protocol::VirtualNetwork network(std::move(cluster));
  std::vector<std::unique_ptr<WorkingRank>> ranks;
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : ids_of(run.speeds)) {
    ranks.push_back(std::make_unique<WorkingRank>(
        network.transport(r), run.layout, run.work, policy, run.options,
        WorkingRank::Options{.slice = run.slice, .planning_speed = run.options.reference_speed}));
    steps.emplace_back([rank = ranks.back().get()] { return rank->step(); });
  }
  if (network.run(steps).end != protocol::RunEnd::kFinished) throw Error("the replayed ranks wait for each other");
  ReplayedRun replayed{.seconds = network.makespan()};
  for (const auto& rank : ranks) replayed.moves += rank->counts().moves;
  return replayed;
}

}  // namespace driftmesh
