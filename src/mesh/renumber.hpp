#pragma once

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// What becomes of the vertices that were given: input points and the ends of shell pieces.
enum class GivenVertices {
  kSorted,  ///< like all others
  kFirst,   ///< they come first, in the order that they have: who knows them by number goes on to
};

/// Drops free slots, sorts triangles along a Hilbert curve and vertices by their first use, so that what is near in the
/// plane is near in memory. All handles change; origins, roots and paths keep their meaning. Vertices that no triangle
/// uses are dropped.
void renumber(Triangulation& mesh, GivenVertices given);

/// Drops free slots and unused vertices, keeping the order of the rest.
void compact(Triangulation& mesh);

}  // namespace driftmesh
