#pragma once

#include "app/run_notes.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "job/team.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::app {

/// Meshes a repaired domain by partially coupled refinement (src/pdr), the ranks of the team together, and notes what
/// each of them did. All ranks give the same domain and bounds. The mesh is on rank 0. Collective; an error on one rank
/// ends the job.
[[nodiscard]] Mesh mesh_on_lattice(job::Team& team, const Pslg& pslg, const QualityBounds& bounds, RunNotes& notes);

}  // namespace driftmesh::app
