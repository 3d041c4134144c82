#pragma once

#include <cstdint>
#include <functional>

#include "cluster/cluster_run.hpp"
#include "cluster/cluster_spec.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"
#include "runtime/run_plan.hpp"
#include "study/pdr/part.hpp"

namespace driftmesh::pdr {

/// Callbacks during the simulation; each may be empty.
struct SimulationObservers {
  std::function<void(std::int64_t triangles)> progress;  ///< called from time to time with the sum over all ranks
  /// Each rank, in order, once all are done. Its mesh has only the triangles of its own cells.
  std::function<void(Part& part, Rank rank, const RankOutcome& outcome)> finished;
};

/// Refines `mesh`, triangulated and with its corners prepared, on simulated ranks within this process. The meshes are
/// really made; only time is simulated. A point costs costs.point on each rank that inserts it: at the start, which
/// every rank makes for itself, in its own cells, and where it repeats what others did. Where triangles stand for many
/// (cluster.scale), the start far from a rank's cells costs that much less: the same lattice would do for all of them.
/// Throws Error as start and CellRefiner::refine do, and whatever the observers throw.
[[nodiscard]] ClusterRun simulate(Triangulation mesh, const QualityBounds& bounds, const ClusterSpec& cluster,
                                  const CostModel& costs = {}, const SimulationObservers& observers = {});

}  // namespace driftmesh::pdr
