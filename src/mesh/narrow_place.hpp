#pragma once

#include <optional>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A place where two segments without a common end run side by side.
struct NarrowPlace {
  Point at;          ///< on one of them, where they are closest
  double width;      ///< their distance there
  double length;     ///< of the part of one segment that the other runs along
  double triangles;  ///< number that a mesh with good angles is expected to need between them
};

/// The place of the domain that needs the most triangles to resolve the distance between two segments: whatever the
/// area bound, points along them cannot be much farther apart than the segments are. `mesh` is a constrained Delaunay
/// triangulation before refinement; considered are pairs of segments that see each other across one of its triangles.
/// Empty if there is no such pair.
[[nodiscard]] std::optional<NarrowPlace> find_narrow_place(const Triangulation& mesh);

}  // namespace driftmesh
