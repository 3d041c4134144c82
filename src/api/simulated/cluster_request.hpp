#pragma once

#include "driftmesh/simulated.hpp"
#include "job/request.hpp"

namespace driftmesh {

/// Calls visit(key, member, value, place) for each member of a cluster, as visit_options does for options. `Cluster` is
/// SimulatedCluster, const or not.
template <class Cluster, class Visit>
void visit_cluster(Cluster&& c, job::Request& r, const Visit& visit) {
  visit("cluster.ranks", "ranks", c.ranks, r.cluster.ranks);
  visit("cluster.speed", "speed", c.speed, r.cluster.speed);
  visit("cluster.rank-speeds", "rank_speeds", c.rank_speeds, r.cluster.rank_speeds);
  visit("cluster.latency", "latency", c.latency, r.cluster.latency);
  visit("cluster.bandwidth", "bandwidth", c.bandwidth, r.cluster.bandwidth);
  visit("cluster.message-overhead", "message_overhead", c.message_overhead, r.cluster.message_overhead);
  visit("cluster.scale", "scale", c.scale, r.cluster.scale);
}

}  // namespace driftmesh
