#pragma once

#include <cstdint>
#include <vector>

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"
#include "patch/domain.hpp"
#include "patch/old_places.hpp"
#include "patch/part.hpp"

namespace driftmesh::patch {

/// A domain that was meshed.
struct Attempt {
  Triangulation mesh;
  Domain domain;
  std::vector<std::int32_t> tight;  ///< points of the part around which bounds cannot be met without more room
};

/// Meshes a domain in place of the triangles of a part that are taken. Throws LimitError above so many triangles.
[[nodiscard]] Attempt attempt(Domain domain, const Part& part, const Extent& extent, const OldPlaces& old,
                              const QualityBounds& bounds, std::int64_t most_triangles);

}  // namespace driftmesh::patch
