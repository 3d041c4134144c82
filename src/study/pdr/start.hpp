#pragma once

#include <cstdint>

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"
#include "study/pdr/lattice.hpp"

namespace driftmesh::pdr {

/// Refines `mesh`, triangulated and with its corners prepared, as far as partially coupled refinement needs it, and
/// lays a lattice for this number of ranks over it, with cells of many times its largest circumradius. Sequential and
/// deterministic: each rank does it and gets the same. Throws Error unless bounds.max_area is positive, there is no
/// size field, and the bound on angles is positive.
[[nodiscard]] Lattice start(Triangulation& mesh, const QualityBounds& bounds, std::int32_t ranks);

}  // namespace driftmesh::pdr
