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
#include "runtime/plan_run.hpp"

namespace driftmesh::patch {

/// A domain that was meshed.
struct Attempt {
  Mesh mesh;                        ///< in subdomains if it is large, and whole: then nothing stays beside it
  std::vector<std::int32_t> tight;  ///< points of the part around which bounds cannot be met without more room
};

/// What a domain is meshed with.
struct Making {
  std::span<const SizeField* const> sizes;  ///< the same field for each thread, an object of its own
  std::int64_t most_triangles = INT64_MAX;  ///< more is a LimitError
  double cut_from = kWorthCutting;          ///< triangles to be made for which a domain is cut
};

/// Meshes a domain in place of the triangles of a part that are taken. Sizes are in place of that of the bounds.
[[nodiscard]] Attempt attempt(const Domain& domain, const Part& part, const Extent& extent, const OldPlaces& old,
                              QualityBounds bounds, const Making& making);

}  // namespace driftmesh::patch
