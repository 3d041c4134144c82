#pragma once

#include <map>
#include <memory>
#include <vector>

#include "adapt/linear_lengths.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "dyadic/path.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {

/// By how much a length must have grown before vertices that were made for it are reconsidered: less happens all the
/// time, and lengths at vertices are compared with those by which they were made, so that small steps add up.
inline constexpr double kGrown = 1.05;

/// The points that have to stay on each shared root, ascending; midpoints on other roots go as lengths say.
using PointsToKeep = std::map<RootId, std::vector<dyadic::Path>>;

/// A mesh that is less dense where lengths have grown.
struct Mended {
  std::shared_ptr<const SubdomainMesh> mesh;  ///< vertices that are left have the numbers that they had
  std::vector<TriangleId> open;               ///< triangles that are new, or too large
};

/// Deletes free vertices, and midpoints on segments, that lengths have no use for any more: in the order of memory,
/// where the triangles that take their place will meet their bounds. What is left to do is refinement. `made_for`: the
/// lengths at vertices by which they were made; bounds.size: what lengths are between them, if they are not linear.
[[nodiscard]] Mended mend(const SubdomainMesh& part, const Lengths& made_for, const Lengths& lengths,
                          const QualityBounds& bounds, const PointsToKeep& keep);

}  // namespace driftmesh::adapt
