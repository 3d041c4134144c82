#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/bounds.hpp"
#include "patch/domain.hpp"
#include "patch/old_places.hpp"
#include "patch/part.hpp"

namespace driftmesh::patch {

/// A domain that was meshed.
struct Attempt {
  Mesh mesh;                        ///< in subdomains if it is large, and whole: then nothing stays beside it
  std::vector<std::int32_t> tight;  ///< points of the part around which bounds cannot be met without more room
};

/// Meshes a domain in place of the triangles of a part that are taken. `sizes`: the same size field for each thread, an
/// object of its own, in place of that of the bounds. Throws LimitError above so many triangles.
[[nodiscard]] Attempt attempt(const Domain& domain, const Part& part, const Extent& extent, const OldPlaces& old,
                              QualityBounds bounds, std::span<const SizeField* const> sizes,
                              std::int64_t most_triangles);

}  // namespace driftmesh::patch
