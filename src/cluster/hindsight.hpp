#pragma once

#include "cluster/cluster_run.hpp"

namespace driftmesh {

/// The work on each subdomain of a run: the seconds of its slices times the speeds of the ranks that did them, at that
/// time. `schedules`: how speeds changed; empty if they did not.
[[nodiscard]] IdVector<SubdomainId, double> work_done(const ClusterRun& run, const IdVector<Rank, double>& speeds,
                                                      const IdVector<Rank, protocol::SpeedSchedule>& schedules);

/// When the last rank would finish if subdomains had been assigned from the start by somebody who knew the work on each
/// and how speeds change, and nothing else took time: largest first, each to the rank that would finish it first
/// (Graham 1969). Later than the ideal time since subdomains are not divided; no balancer of whole subdomains ends much
/// earlier.
[[nodiscard]] double oracle_seconds(const IdVector<SubdomainId, double>& work, const IdVector<Rank, double>& speeds,
                                    const IdVector<Rank, protocol::SpeedSchedule>& schedules);

}  // namespace driftmesh
