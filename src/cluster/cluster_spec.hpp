#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/run_plan.hpp"

namespace driftmesh {

/// Ranks of one kind.
struct RankGroup {
  std::string name;
  std::int32_t ranks = 1;
  double speed = 0;  ///< triangles a second that one of them refines; 0: reference_speed
};

/// A cluster to simulate. Ranks are numbered consecutively through the groups. Every rank has its own link to all
/// others.
struct ClusterSpec {
  std::vector<RankGroup> groups;
  IdVector<Rank, double> drag;  ///< the fraction of its speed that is left to a rank; empty: all of it
  double latency = 50e-6;       ///< seconds from the end of sending to arrival
  double bandwidth = 1e9;       ///< bytes per second that leave a rank
  double message_overhead =
      1e-6;  ///< seconds of a rank, whatever its speed, for each message that it sends or receives
};

/// Triangles a second that a rank with these costs refines in subdomains of some thousands: a point makes two
/// triangles, less a tenth for points on borders, which make fewer, and for the preparation of subdomains. With the
/// usual costs that is a core of the machine in docs/benchmarks.md, whatever machine simulates.
[[nodiscard]] double reference_speed(const CostModel& costs);

[[nodiscard]] std::int32_t ranks_of(const ClusterSpec& cluster);
/// Triangles a second of each rank. Throws Error for a cluster without ranks, a group without ranks, speeds below 0,
/// and drag for another number of ranks or not above 0.
[[nodiscard]] IdVector<Rank, double> speeds_of(const ClusterSpec& cluster, const CostModel& costs);
/// The group of each rank.
[[nodiscard]] IdVector<Rank, std::size_t> groups_of(const ClusterSpec& cluster);

}  // namespace driftmesh
