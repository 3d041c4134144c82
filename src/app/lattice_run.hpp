#pragma once

#include "app/run_notes.hpp"
#include "cluster/cluster_run.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "job/limits.hpp"
#include "job/record.hpp"
#include "job/team.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "mesh/bounds.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::app {

/// Meshes a repaired domain by partially coupled refinement (src/pdr), the ranks of the team together, and notes what
/// each of them did. All ranks give the same domain and bounds. The mesh is on rank 0. Collective; an error on one rank
/// ends the job.
[[nodiscard]] Mesh mesh_on_lattice(job::Team& team, const Pslg& pslg, const QualityBounds& bounds, RunNotes& notes);

/// Makes the mesh of an experiment by partially coupled refinement on its simulated cluster, in virtual time, and adds
/// what the ranks report to `record`. Throws KeyError if nothing bounds the size of triangles, LimitError if there are
/// more than `limits` allow, and whatever pdr::simulate throws.
[[nodiscard]] ClusterRun simulate_on_lattice(const job::Request& request, job::Triangulated&& triangulated,
                                             const job::Limits& limits, const CostModel& costs, job::RunRecord& record,
                                             job::Watch& watch);

/// Throws KeyError unless there is a bound on the area of all triangles.
void require_area_bound(const QualityBounds& bounds);

}  // namespace driftmesh::app
