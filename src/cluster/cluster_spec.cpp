#include "cluster/cluster_spec.hpp"

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

double reference_speed(const CostModel& costs) {
  constexpr double kTriangles = 5000, kMeasuredPerPoint = 1.886;  // points on borders add fewer than kTrianglesPerPoint
  return kTriangles / (costs.start + kTriangles / kMeasuredPerPoint * costs.point);
}

CostModel scaled(CostModel costs, double scale) {
  costs.start /= scale;
  costs.listed /= scale;
  for (auto& [kind, unit] : costs.planning.unit) unit /= scale;
  return costs;
}

double cutting_seconds(const CostModel& costs, std::size_t subdomains) {
  const auto n = static_cast<double>(std::max<std::size_t>(subdomains, 1));
  return costs.cut * n * std::log2(n);
}

std::int32_t ranks_of(const ClusterSpec& cluster) {
  std::int32_t ranks = 0;
  for (const RankGroup& group : cluster.groups) ranks += group.ranks;
  return ranks;
}

IdVector<Rank, double> speeds_of(const ClusterSpec& cluster, const CostModel& costs) {
  const double reference = reference_speed(scaled(costs, cluster.scale));
  IdVector<Rank, double> speeds;
  for (const RankGroup& group : cluster.groups) {
    if (group.ranks < 1)
      throw Error("group '" + group.name + "' of the cluster has " + std::to_string(group.ranks) +
                  " ranks; give it at least one");
    if (!(group.speed >= 0 && std::isfinite(group.speed)))
      throw Error(
          formatted("group '{}' of the cluster has a speed of {} triangles per second; it must be above 0, or 0 for "
                    "the speed of the machine in docs/benchmarks.md",
                    group.name, group.speed));
    speeds.insert(speeds.end(), to_index(group.ranks), group.speed > 0 ? group.speed : reference);
  }
  if (speeds.empty()) throw Error("a cluster needs at least one rank");
  if (cluster.drag.empty()) return speeds;
  if (cluster.drag.size() != speeds.size())
    throw Error("the cluster has " + std::to_string(speeds.size()) + " ranks, but drag for " +
                std::to_string(cluster.drag.size()));
  for (const Rank r : ids_of(speeds)) {
    if (!(cluster.drag[r] > 0))
      throw Error("rank " + to_string(r) + " of the cluster has no speed left; its drag must be above 0");
    speeds[r] *= cluster.drag[r];
  }
  return speeds;
}

IdVector<Rank, protocol::SpeedSchedule> schedules_of(const ClusterSpec& cluster) {
  const std::int32_t ranks = ranks_of(cluster);
  IdVector<Rank, std::vector<protocol::SpeedChange>> changes(to_index(ranks));
  for (const RankChange& change : cluster.changes) {
    if (change.rank < 0 || change.ranks < 1 || change.rank > ranks - change.ranks)
      throw Error("the speeds of ranks " + std::to_string(change.rank) + " to " +
                  std::to_string(static_cast<std::int64_t>(change.rank) + change.ranks - 1) +
                  " are to change, but the cluster has " + std::to_string(ranks) + " ranks");
    for (std::int32_t r = change.rank; r < change.rank + change.ranks; ++r)
      changes[Rank{r}].push_back({change.at, change.factor});
  }
  IdVector<Rank, protocol::SpeedSchedule> schedules;
  for (const std::vector<protocol::SpeedChange>& of_rank : changes) schedules.emplace_back(of_rank);
  return schedules;
}

IdVector<Rank, bool> late_ranks_of(const ClusterSpec& cluster) {
  IdVector<Rank, bool> late;
  for (const protocol::SpeedSchedule& schedule : schedules_of(cluster)) late.push_back(schedule.present_from(0) > 0);
  return late;
}

}  // namespace driftmesh
