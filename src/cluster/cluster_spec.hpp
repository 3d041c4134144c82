#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "protocol/speed_schedule.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Ranks of one kind.
struct RankGroup {
  std::string name;
  std::int32_t ranks = 1;
  double speed = 0;  ///< triangles per second that each of them refines; 0: reference_speed
};

/// From a moment on, some ranks have another speed.
struct RankChange {
  std::int32_t rank = 0;   ///< the first of them
  std::int32_t ranks = 1;  ///< their number
  double at = 0;           ///< seconds since the start of refinement
  double factor = 1;       ///< fraction of the speed that they have otherwise; 0: they are not there
};

/// A cluster to simulate. Ranks are numbered consecutively through the groups. Every host has a link to all others,
/// which its ranks share; within a host messages go through memory (see protocol::VirtualCluster).
struct ClusterSpec {
  std::vector<RankGroup> groups;
  std::vector<RankChange> changes;  ///< changes of speed, those of a rank in the order of time
  IdVector<Rank, double> drag;      ///< the fraction of its speed that each rank keeps; empty: all of it
  double memory = 0;                ///< triangles for which each rank has memory, and takes nine tenths; 0: any number
  double latency = defaults::kLatency;      ///< seconds from the end of sending to arrival
  double bandwidth = defaults::kBandwidth;  ///< bytes per second that leave a host
  std::int32_t ranks_per_host = 1;          ///< consecutive ones
  double scale = 1;  ///< triangles that each one stands for: what depends on subdomains alone costs that much less
  /// Seconds that a rank of any speed spends on each message that it sends or receives.
  double message_overhead = defaults::kMessageOverhead;
};

/// Triangles per second that a rank with these costs refines in subdomains of several thousand triangles: each point
/// makes two triangles, less a twentieth for points on borders, which make fewer, and subdomains must be started. With
/// the default costs this is the speed of a core of the machine in docs/benchmarks.md, no matter which machine
/// simulates.
[[nodiscard]] double reference_speed(const CostModel& costs);

/// The costs where each triangle stands for many (see ClusterSpec::scale): what depends on subdomains alone, not on
/// their triangles, is not scaled up with the triangles' costs.
[[nodiscard]] CostModel scaled(CostModel costs, double scale);

/// Seconds that it takes to cut a domain into that many subdomains, by halving. Not a matter of the ranks' speeds,
/// which may stand for larger meshes in the same subdomains.
[[nodiscard]] double cutting_seconds(const CostModel& costs, std::size_t subdomains);

[[nodiscard]] std::int32_t ranks_of(const ClusterSpec& cluster);
/// The speed of each rank in triangles per second. Throws Error for a cluster without ranks, a group without ranks,
/// negative speeds, and drag that is not positive or given for another number of ranks.
[[nodiscard]] IdVector<Rank, double> speeds_of(const ClusterSpec& cluster, const CostModel& costs);
/// How the speed of each rank changes. Throws Error for ranks that the cluster lacks, and as SpeedSchedule does.
[[nodiscard]] IdVector<Rank, protocol::SpeedSchedule> schedules_of(const ClusterSpec& cluster);
/// Whether each rank is not there at the start.
[[nodiscard]] IdVector<Rank, bool> late_ranks_of(const ClusterSpec& cluster);

}  // namespace driftmesh
