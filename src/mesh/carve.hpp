#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/triangulation.hpp"
#include "pslg/pslg.hpp"

namespace driftmesh {

/// The triangle that holds `p` (inside or on its border), found by a walk from `start` that also crosses constrained
/// edges; kNone if the walk leaves the triangulation.
[[nodiscard]] TriangleId locate(const Triangulation& mesh, const Point& p, TriangleId start);

/// Removes the outside of a domain (what reaches the frame, the triangulation's border, without crossing a segment)
/// and its holes from a triangulation of a box around it, drops the segments that bound nothing any more, and labels
/// the regions. Throws Error if nothing is left.
void carve(Triangulation& mesh, const Pslg& pslg);

/// What lies left and right of a segment, seen from its first point to its second: a region label, or kNone outside the
/// domain.
struct SegmentSides {
  std::int32_t left = kNone;
  std::int32_t right = kNone;
};

/// The same for a domain given by the sides of its segments, which are the roots from `first_root` on.
void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root);

}  // namespace driftmesh
