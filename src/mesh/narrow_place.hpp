#pragma once

#include <optional>
#include <vector>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A place where two segments without a common end run side by side.
struct NarrowPlace {
  Point at;          ///< on one of them, where they are closest
  double width;      ///< their distance there
  double length;     ///< length of the part of one segment that the other runs along
  double triangles;  ///< number that a mesh with good angles is expected to need between them
};

/// The places of the domain that need dozens of triangles or more to resolve the distance between two segments, the
/// most expensive first: whatever the area bound, points along the segments cannot be much farther apart than the
/// segments are. `mesh` is a constrained Delaunay triangulation before refinement, its corners prepared: pieces of one
/// shell do not count. Considered are pairs of segments that see each other across one of its triangles. Takes linear
/// time, but for sorting.
[[nodiscard]] std::vector<NarrowPlace> find_narrow_places(const Triangulation& mesh);

/// The most expensive of them, if there is any.
[[nodiscard]] std::optional<NarrowPlace> find_narrow_place(const Triangulation& mesh);

}  // namespace driftmesh
