#pragma once

#include "cluster/cluster_spec.hpp"
#include "protocol/virtual_network.hpp"

namespace driftmesh {

/// The ranks of `cluster` as a network simulates them, where work has these costs. Throws Error as speeds_of and
/// schedules_of do.
[[nodiscard]] protocol::VirtualCluster virtual_cluster(const ClusterSpec& cluster, const CostModel& costs);

}  // namespace driftmesh
