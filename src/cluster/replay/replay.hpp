#pragma once

#include <memory>

#include "balancer/controller.hpp"
#include "cluster/replay/working_rank.hpp"
#include "driftmesh/policy.hpp"
#include "protocol/speed_schedule.hpp"

namespace driftmesh {

/// What a run did, as far as balancing is concerned: how much work each subdomain was and on which ranks it could be
/// done.
struct RecordedRun {
  std::shared_ptr<const balancer::Layout> layout;
  IdVector<SubdomainId, CountedWork> work;
  IdVector<Rank, double> speeds;                      ///< triangles a second
  IdVector<Rank, protocol::SpeedSchedule> schedules;  ///< how they change; empty: not at all
  double latency = 50e-6;                             ///< seconds
  double bandwidth = 1e9;                             ///< bytes a second
  double message_overhead = 1e-6;                     ///< seconds
  double slice = 16384;                               ///< triangles
  balancer::ControllerOptions options;
};

struct ReplayedRun {
  double seconds = 0;  ///< until the last rank knows that all work is done
  int moves = 0;
};

/// The recorded work anew, in virtual time, with another policy: real controllers and messages, charged planning, no
/// meshing. Subdomains do not depend on each other, and take what they took in the recorded run wherever they are.
/// Throws Error if the ranks get stuck.
[[nodiscard]] ReplayedRun replay(const RecordedRun& run, const std::shared_ptr<const balancer::Policy>& policy);

}  // namespace driftmesh
