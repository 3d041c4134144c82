#pragma once

#include "driftmesh/pslg.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"

namespace driftmesh::testing {

/// The triangulation of a domain with corners prepared for refinement.
[[nodiscard]] inline Triangulation prepared(const Pslg& pslg) {
  Triangulation mesh = triangulate(pslg);
  prepare_corners(mesh);
  return mesh;
}

}  // namespace driftmesh::testing
