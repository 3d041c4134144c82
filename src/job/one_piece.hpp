#pragma once

#include "job/domain.hpp"
#include "job/limits.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "mesh/mesher.hpp"

namespace driftmesh::job {

/// A mesh of the whole domain, and what limited it.
struct OnePiece {
  MeshResult result;  ///< not complete if a limit stopped it
  Limits limits;
  double forecast = 0;  ///< of triangles, before refinement
};

/// Meshes the domain as one piece. `writes`: the mesh is written or drawn afterward, which takes memory too. Throws
/// Error for what the domain and the bounds do not allow, and LimitError before the work if far more triangles than the
/// limits allow are to be expected and the request does not keep incomplete meshes. `may_keep`: it could.
[[nodiscard]] OnePiece mesh_in_one_piece(const Request& request, const Domain& domain, bool writes, Watch& watch,
                                         bool may_keep = true);

}  // namespace driftmesh::job
