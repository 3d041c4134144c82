#pragma once

#include "app/run_notes.hpp"
#include "cluster/cluster_run.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"
#include "job/limits.hpp"
#include "job/record.hpp"
#include "job/team.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "mesh/bounds.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::app {

/// A domain to be meshed on a lattice.
struct BoundedDomain {
  Pslg pslg;             ///< repaired
  QualityBounds bounds;  ///< of which that on the area holds everywhere
};

/// What the request asks for, on all ranks, as rank 0 finds and records it. Collective; an error on rank 0 is one on
/// all. Throws KeyError if nothing bounds the size of triangles, LimitError if far too many are expected, and what
/// read_domain and triangulate_domain throw.
[[nodiscard]] BoundedDomain share_domain(const job::Request& request, const job::Use& use, job::Team& team,
                                         RunNotes& notes);

/// Meshes a domain by partially coupled refinement (src/pdr), the ranks of the team together, and notes what each of
/// them did. All ranks give the same domain. Returns the rank's piece. Collective; an error on one rank ends the job.
[[nodiscard]] DistributedPiece mesh_on_lattice(job::Team& team, const BoundedDomain& domain, RunNotes& notes);

/// Makes the mesh of an experiment by partially coupled refinement on its simulated cluster, in virtual time, and adds
/// what the ranks report to `record`. Throws KeyError if nothing bounds the size of triangles, LimitError if there are
/// more than `limits` allow, and whatever pdr::simulate throws.
[[nodiscard]] ClusterRun simulate_on_lattice(const job::Request& request, job::Triangulated&& triangulated,
                                             const job::Limits& limits, const CostModel& costs, job::RunRecord& record,
                                             job::Watch& watch);

}  // namespace driftmesh::app
