#pragma once

#include <memory>
#include <vector>

#include "base/growing_array.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/size_field.hpp"
#include "dyadic/split_point.hpp"

namespace driftmesh {

/// What a subdomain of a later generation (docs/theory.md) begins with.
struct Beginning {
  using Lengths = GrowingArray<double, VertexId>;

  const SizeField* size = nullptr;  ///< in place of the bounds'; asked by one thread at a time. Not owned
  /// Its mesh so far; null: it is made from its outline.
  std::shared_ptr<const SubdomainMesh> mesh{};
  const Lengths* lengths =
      nullptr;                     ///< those that `size` has at the vertices of the mesh; null: it is asked. Not owned
  std::vector<TriangleId> open{};  ///< triangles of the mesh that may miss their bounds
  std::vector<SplitPoint<GlobalRootId>> told{};  ///< points on its border that the mesh lacks
};

}  // namespace driftmesh
