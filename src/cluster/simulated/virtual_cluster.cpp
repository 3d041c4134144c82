#include "cluster/simulated/virtual_cluster.hpp"

namespace driftmesh {

protocol::VirtualCluster virtual_cluster(const ClusterSpec& cluster, const CostModel& costs) {
  protocol::VirtualCluster made;
  made.speeds = speeds_of(cluster, costs);
  const double reference = reference_speed(scaled(costs, cluster.scale));
  for (double& speed : made.speeds) speed /= reference;
  made.schedules = schedules_of(cluster);
  const protocol::Link link{cluster.latency, cluster.bandwidth};
  made.link = [link](Rank, Rank) { return link; };
  made.ranks_per_host = cluster.ranks_per_host;
  made.message_overhead = cluster.message_overhead;
  return made;
}

}  // namespace driftmesh
