#pragma once

#include <vector>

#include "adapt/generation.hpp"
#include "adapt/move.hpp"
#include "decompose/glue_subdomains.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/handles.hpp"

namespace driftmesh::adapt {

/// What a part consists of: vertices and triangles of parts of the same mesh as it was numbered before.
struct Former {
  std::vector<SubdomainId> parts;  ///< which `vertex` and `triangle` count
  // Empty: it is the first of these, with the same numbers.
  IdVector<VertexId, InMesh<VertexId>> vertex{};
  IdVector<TriangleId, InMesh<TriangleId>> triangle{};
};

/// What a rank has of a mesh that is in other parts now, but on the same rank point by point and triangle by triangle.
/// `former`: for each part that is here.
[[nodiscard]] Holding renumbered(const Held& present, Generation now, const IdVector<SubdomainId, Former>& former);

}  // namespace driftmesh::adapt
