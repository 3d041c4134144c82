#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The triangle that holds `p` (inside or on its border), found by a walk from `start` that also crosses constrained
/// edges; kNone if the walk leaves the triangulation.
[[nodiscard]] TriangleId locate(const Triangulation& mesh, const Point& p, TriangleId start);

/// Carves a domain out of the triangulation of a box around it: removes its outside (all that can be reached from the
/// box's border without crossing a segment) and its holes, drops the segments that no longer bound a triangle, and
/// labels the regions. Throws Error if nothing is left.
void carve(Triangulation& mesh, const Pslg& pslg);

/// The region labels left and right of a segment, seen from its first point to its second; kNone outside the domain.
struct SegmentSides {
  std::int32_t left = kNone;
  std::int32_t right = kNone;
};

/// The same for a domain that is given by the sides of its segments, the roots from `first_root` on.
void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root);

}  // namespace driftmesh
