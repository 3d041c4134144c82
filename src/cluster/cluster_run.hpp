#pragma once

#include <cstdint>
#include <vector>

#include "balancer/snapshot/deliberation.hpp"
#include "driftmesh/ids.hpp"
#include "protocol/speed_schedule.hpp"
#include "runtime/rank_outcome.hpp"

namespace driftmesh {

/// The load of one rank at one moment.
struct LoadSample {
  double time = 0;                       ///< seconds since the start of the run
  Rank rank{};                           ///< the rank whose load changed at that time
  std::int64_t triangles = 0;            ///< total in its subdomains
  double remaining = 0;                  ///< expected number still to be made
  double worked = 0;                     ///< seconds of refinement that ended at that time
  SubdomainId subdomain = kNoSubdomain;  ///< the one refined, if `worked` is above 0
};

/// Points that a slice of work inserted on the interfaces of a subdomain with one neighbor.
struct SplitRecord {
  double time = 0;  ///< when the slice ended
  Rank rank{};      ///< the rank that did the slice
  SubdomainId from{}, to{};
  std::int32_t points = 0;
};

/// A subdomain that moved from one rank to another.
struct MoveRecord {
  SubdomainId subdomain{};
  Rank from{}, to{};
  double left = 0, arrived = 0;  ///< when it was packed and sent, and when unpacked; seconds since the start of the run
  std::uint64_t bytes = 0;       ///< its packed size
};

/// Results of a run on a real or simulated cluster.
struct ClusterRun {
  double makespan = 0;  ///< seconds from the start until the last rank knows that all work is done
  double cutting = 0;   ///< seconds before the start, in which rank 0 cuts the domain; only known of simulated clusters
  IdVector<Rank, RankOutcome> ranks;
  std::vector<MoveRecord> moves;                      ///< in order of departure
  std::vector<LoadSample> samples;                    ///< in the order of time
  std::vector<SplitRecord> splits;                    ///< in the order of time
  std::vector<balancer::Deliberation> deliberations;  ///< in the order of time
  IdVector<SubdomainId, Rank> owners;                 ///< at the end

  [[nodiscard]] std::int64_t triangles() const;
  [[nodiscard]] std::uint64_t messages() const;       ///< sum over all ranks, termination included
  [[nodiscard]] std::uint64_t message_bytes() const;  ///< bytes in these messages
};

/// The time in seconds that the work of `run` would take if every rank computed from start to end: the sum of computing
/// times weighted by speed over the sum of speeds.
[[nodiscard]] double ideal_seconds(const ClusterRun& run, const IdVector<Rank, double>& speeds);
/// The same where speeds change over time: when all ranks together have had the time for it.
[[nodiscard]] double ideal_seconds(const ClusterRun& run, const IdVector<Rank, double>& speeds,
                                   const IdVector<Rank, protocol::SpeedSchedule>& schedules);

}  // namespace driftmesh
