#pragma once

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// How the given vertices (input points and the ends of shell pieces) are numbered.
enum class GivenVertices {
  kSorted,  ///< like all others
  kFirst,   ///< first, in their current order: a caller's numbers for them stay valid if they were first before
};

/// Drops free slots and unused vertices, and sorts triangles along a Hilbert curve and vertices by first use, so that
/// neighbors in the plane are neighbors in memory. All handles of triangles and vertices change; origins, roots and
/// paths keep their meaning.
void renumber(Triangulation& mesh, GivenVertices given);

/// Drops free slots and unused vertices, keeping the order of the rest.
void compact(Triangulation& mesh);

/// Drops the slots of subsegments that undo_midpoint (flips.hpp) has left, keeping the order of the rest.
void drop_unused_subsegments(Triangulation& mesh);

}  // namespace driftmesh
