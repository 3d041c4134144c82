#pragma once

#include <cstdint>

#include "driftmesh/ids.hpp"
#include "mesh/triangulation.hpp"
#include "study/pdr/cell_refiner.hpp"
#include "study/pdr/lattice.hpp"

namespace driftmesh::pdr {

/// Removes the triangles of other ranks' cells. What is left can be measured, not refined.
void keep_own_triangles(Triangulation& mesh, const CellRefiner& cells, const Lattice& lattice, Rank rank);

/// What a rank has of the whole mesh, whose triangles each belong to one rank, and so do points and subsegments: to the
/// rank of the cell in which they, or their first ends, lie.
struct OwnCounts {
  std::int64_t vertices = 0, subsegments = 0;
};
[[nodiscard]] OwnCounts count_own(const Triangulation& mesh, const Lattice& lattice, Rank rank);

}  // namespace driftmesh::pdr
