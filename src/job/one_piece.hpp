#pragma once

#include "job/domain.hpp"
#include "job/limits.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"
#include "mesh/mesher.hpp"

namespace driftmesh::job {

/// A mesh of the whole domain, and what limited it.
struct OnePiece {
  MeshResult result;  ///< not complete if a limit stopped it
  Limits limits;
  bool by_memory = false;  ///< whether it was the limit on memory
  double forecast = 0;     ///< of triangles, before refinement
};

/// Meshes the domain, triangulated, as one piece. `writes`: the mesh is written or plotted afterward, which takes
/// memory too. Throws Error if domain and bounds are incompatible, and LimitError before the work if the forecast far
/// exceeds the limits and the request does not keep incomplete meshes. `may_keep`: whether the request could ask to
/// keep one.
[[nodiscard]] OnePiece mesh_in_one_piece(const Request& request, const Domain& domain, Triangulated&& triangulated,
                                         bool writes, Watch& watch, bool may_keep = true);

}  // namespace driftmesh::job
