#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "mesh/polygon_cover.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The triangle that holds `p` (inside or on its border), found by a walk from `start` that also crosses constrained
/// edges; kNone if the walk leaves the triangulation.
[[nodiscard]] TriangleId locate(const Triangulation& mesh, const Point& p, TriangleId start);

/// What carving found that the author of the input may not have meant. Indices are those of the PSLG.
struct CarveReport {
  std::vector<std::int32_t> dropped;  ///< segments that bound no part of the domain, without those of polygons
  struct Meeting {
    std::int32_t first, second;
  };
  std::vector<Meeting> meetings;  ///< regions whose points lie in one area; the second one's label holds there
  struct Flaw {
    PolygonFlaw what;
    std::optional<Point> at;  ///< none of a polygon without corners
  };
  std::vector<Flaw> flaws;   ///< faults of polygons, each with its place
  std::vector<Point> holes;  ///< with polygons: a point in each bounded part of the plane that is not in the domain
};

/// Carves a domain out of the triangulation of a box around it: removes what no polygon covers or, if there are no
/// polygons, all that can be reached from the box's border without crossing a segment; removes what the hole points
/// reach; drops the segments that no longer bound a triangle, and labels the regions. The segments of the PSLG are the
/// roots from `first_root` on; none are dropped if it has none. Throws Error if nothing is left.
CarveReport carve(Triangulation& mesh, const Pslg& pslg, std::size_t first_root);

/// The region labels left and right of a segment, seen from its first point to its second; kNone outside the domain.
struct SegmentSides {
  std::int32_t left = kNone;
  std::int32_t right = kNone;
};

/// The same for a domain that is given by the sides of its segments, the roots from `first_root` on.
void carve(Triangulation& mesh, const std::vector<SegmentSides>& sides, std::size_t first_root);

}  // namespace driftmesh
