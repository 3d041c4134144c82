#pragma once

#include <memory>
#include <vector>

#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/size_field.hpp"
#include "dyadic/split_point.hpp"

namespace driftmesh {

/// What a subdomain of a later generation (docs/theory.md) begins with.
struct Beginning {
  const SizeField* size = nullptr;               ///< in place of the bounds'; asked by one thread at a time. Not owned
  std::shared_ptr<const SubdomainMesh> mesh{};   ///< one that meets all bounds; null: it is made from its outline
  std::vector<SplitPoint<GlobalRootId>> told{};  ///< points on its border that the mesh lacks
};

}  // namespace driftmesh
