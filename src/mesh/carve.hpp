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

/// What carving found that the author of the input may not have meant. Indices are those of the PSLG.
struct CarveReport {
  std::vector<std::int32_t> dropped;  ///< segments that bound no part of the domain
  struct Meeting {
    std::int32_t first, second;
  };
  std::vector<Meeting> meetings;  ///< regions whose points lie in one area; the second one's label holds there
};

/// Carves a domain out of the triangulation of a box around it: removes its outside (all that can be reached from the
/// box's border without crossing a segment) and its holes, drops the segments that no longer bound a triangle, and
/// labels the regions. The segments of the PSLG are the roots from `first_root` on; none are dropped if it has none.
/// Throws Error if nothing is left.
CarveReport carve(Triangulation& mesh, const Pslg& pslg, std::size_t first_root);

/// The region labels left and right of a segment, seen from its first point to its second; kNone outside the domain.
struct SegmentSides {
  std::int32_t left = kNone;
  std::int32_t right = kNone;
};

/// The same for a domain that is given by the sides of its segments, the roots from `first_root` on.
void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root);

}  // namespace driftmesh
