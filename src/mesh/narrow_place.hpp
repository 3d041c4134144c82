#pragma once

#include <optional>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Where two segments without a common end run side by side.
struct NarrowPlace {
  Point at;          ///< on one of them, where they are closest
  double width;      ///< their distance there
  double length;     ///< of the piece of the one that the other runs along
  double triangles;  ///< about as many does a mesh with good angles need between them
};

/// The place of the domain that needs the most triangles to resolve the distance of two segments: along them it has to
/// put points about as far apart as they are, whatever the area bound. `mesh` is a constrained Delaunay triangulation
/// before refinement; pairs of segments that see each other across one of its triangles are looked at. Empty if there
/// is no such pair.
[[nodiscard]] std::optional<NarrowPlace> find_narrow_place(const Triangulation& mesh);

}  // namespace driftmesh
