#pragma once

#include <cstdint>
#include <memory>

#include "balancer/trigger/controller_options.hpp"
#include "cluster/cluster_spec.hpp"
#include "cluster/replay/counted_work.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh {

/// What a run did, as far as balancing is concerned: how much work each subdomain was and on which ranks it could be
/// done.
struct RecordedRun {
  std::shared_ptr<const balancer::Layout> layout;
  IdVector<SubdomainId, Count> work;  ///< their starts included
  ClusterSpec cluster;
  std::int64_t slice = 16384;  ///< insertions
  WorkOrder order = WorkOrder::kGiven;
  balancer::ControllerOptions options;
};

struct ReplayedRun {
  double seconds = 0;  ///< until the last rank knows that all work is done
  std::size_t moves = 0;
};

/// The recorded work anew, in virtual time, with another policy: the loops of real ranks, with their controllers and
/// messages, and charged planning, but no meshing. Subdomains do not depend on each other, and take what they took in
/// the recorded run wherever they are. Throws Error for a cluster as simulate() does, and if the ranks get stuck.
[[nodiscard]] ReplayedRun replay(const RecordedRun& run, const std::shared_ptr<const balancer::Policy>& policy);

}  // namespace driftmesh
