#pragma once

#include <array>

#include "driftmesh/id_vector.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// Where a subdomain's new mesh comes from in its old one.
struct Descent {
  /// A new vertex as a convex combination of old ones.
  struct Source {
    std::array<VertexId, 3> vertex{};
    std::array<double, 3> weight{};
    bool stays = false;  ///< it is at the first of them
  };
  IdVector<VertexId, Source> sources;     ///< one for each vertex
  IdVector<TriangleId, TriangleId> same;  ///< the old triangle with the same corners; kNone: there is none
};

[[nodiscard]] Descent trace(const Triangulation& old_mesh, const Triangulation& new_mesh);

}  // namespace driftmesh::adapt
