#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A cluster in virtual time. Ranges and meanings are those of the keys `cluster.*` in docs/experiments.md. Times are
/// in seconds, speeds in triangles per second.
struct SimulatedCluster {
  std::int32_t ranks = 0;                   ///< their number, unless rank_speeds tells
  double speed = 0;                         ///< the same on every rank; 0: as on the machine in docs/benchmarks.md
  std::vector<double> rank_speeds{};        ///< one for each rank, instead of `ranks` and `speed`
  double latency = defaults::kLatency;      ///< seconds from the end of sending to arrival
  double bandwidth = defaults::kBandwidth;  ///< bytes per second that leave a rank
  double message_overhead = defaults::kMessageOverhead;  ///< seconds for each message that a rank sends or receives
  double scale = 1;                                      ///< triangles that each one stands for
};

/// Results of a run on a simulated cluster. Times are in virtual seconds.
struct SimulatedRun {
  /// A subdomain that moved from one rank to another.
  struct Move {
    SubdomainId subdomain{};
    Rank from{}, to{};
    double left = 0, arrived = 0;
    std::uint64_t bytes = 0;
  };
  /// How a rank spent its time.
  struct RankTimes {
    double computing = 0;
    double sending = 0;
    double polling = 0;
    double balancing = 0;
    double idle = 0;
  };

  double seconds = 0;        ///< from the start until the last rank knows that all work is done
  double ideal_seconds = 0;  ///< if every rank had computed from start to end
  std::int64_t triangles = 0;
  std::uint64_t messages = 0;
  std::uint64_t message_bytes = 0;
  std::vector<Move> moves;          ///< in order of departure
  std::vector<RankTimes> ranks;     ///< one for each rank
  std::vector<double> speeds;       ///< one for each rank
  std::vector<Rank> owners_before;  ///< one for each subdomain
  std::vector<Rank> owners_after;   ///< one for each subdomain
};

/// Makes a mesh on simulated ranks in this process. Meshes and messages are real, only time is simulated: the same
/// arguments give the same result on every machine. Policies are those of a real run, MeshOptions::balance.own among
/// them. The mesh is not kept.
///
/// The whole mesh is held in memory, about 45 bytes per triangle. Throws like mesh(), and Error for a cluster without
/// ranks or with values out of range.
///
/// \code
/// driftmesh::MeshOptions options{.max_area = 20};
/// options.balance.policy = "stealing";
/// const driftmesh::SimulatedRun run =
///     driftmesh::simulate(driftmesh::generate("pipe"), options, {.rank_speeds = {4e6, 4e6, 1e6}});
/// std::cout << run.seconds << " s, at best " << run.ideal_seconds << " s, " << run.moves.size() << " moves\n";
/// \endcode
[[nodiscard]] SimulatedRun simulate(const Pslg& input, const MeshOptions& options, const SimulatedCluster& cluster);

}  // namespace driftmesh
