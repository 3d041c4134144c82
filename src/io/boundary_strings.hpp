#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Consecutive edges of the boundary, with the domain on their left: counterclockwise around the domain, clockwise
/// around its islands.
struct BoundaryString {
  enum class Kind : std::int32_t {
    kOpen,    ///< open sea
    kLand,    ///< of the ring around the domain, or what an open string leaves of an island
    kIsland,  ///< a whole ring inside of the domain; its first vertex follows the last one
  };
  Kind kind = Kind::kLand;
  /// From end to end, where the next string begins. A ring of one string that is no island ends with its first vertex.
  std::vector<std::int32_t> vertices;
};

/// The boundary of a mesh in strings, ring by ring in the order of their first edges in the mesh. Each edge with a
/// triangle on one side only is in exactly one string. Where rings touch in a vertex, each keeps to its own triangles.
/// `is_open` tells for the marker of an edge whether it is open sea; edges that are not in mesh.edges have marker 0.
[[nodiscard]] std::vector<BoundaryString> boundary_strings(const Mesh& mesh,
                                                           const std::function<bool(std::int32_t marker)>& is_open);

}  // namespace driftmesh
