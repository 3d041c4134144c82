#pragma once

#include <span>

#include "adapt/linear_lengths.hpp"
#include "driftmesh/adaptive.hpp"
#include "patch/domain.hpp"
#include "patch/part.hpp"

namespace driftmesh::patch {

/// The length that is asked for at each point of a part: inside what `asked` says, for the points of the whole mesh,
/// as options want it, or if that is empty what the triangles there have; elsewhere so much that the triangles there
/// may stay. `mesh`: the part.
[[nodiscard]] adapt::Lengths lengths_in(const Part& part, const Triangulation& mesh, const Extent& extent,
                                        std::span<const double> asked, const AdaptiveOptions& options);

}  // namespace driftmesh::patch
