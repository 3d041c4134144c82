#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "mesh/areas.hpp"

namespace driftmesh {

/// The areas on both sides of a segment, seen from its first point to its second; kNone for both: not in the
/// triangulation.
struct Wall {
  AreaId left;
  AreaId right;
};

/// A polygon that is not as standards want it, or two that disagree. Its meaning is defined all the same.
struct PolygonFlaw {
  enum class Kind {
    kCrossesItself,  ///< a ring, which encloses an area more than once
    kRepeatsEdge,    ///< a ring, which walks a segment more than once
    kSharesEdge,     ///< a ring walks a segment that another ring of its polygon walks, too
    kLeavesOuter,    ///< a ring other than the first reaches outside the first
    kHolesOverlap,   ///< two rings other than the first
    kCoversNothing,  ///< no area is left of the polygon
    kPartsOverlap,   ///< it overlaps another polygon of its feature
    kRegionsDiffer,  ///< it overlaps another polygon with another region
  };
  Kind kind;
  std::int32_t polygon = 0;      ///< index into the input's polygons
  std::int32_t ring = 0;         ///< number among the polygon's, if the kind names a ring
  std::int32_t other = kNone;    ///< the other ring or polygon, if the kind names one
  AreaId area = kNone;           ///< the place, if it is an area
  std::int32_t segment = kNone;  ///< the place, if it is a segment
};

/// What the polygons of an input cover.
struct PolygonCover {
  IdVector<AreaId, bool> inside;          ///< whether some polygon covers the area
  IdVector<AreaId, std::int32_t> region;  ///< the last polygon's that covers the area and has one; kNone without one
  std::vector<PolygonFlaw> flaws;         ///< the first of each kind for each ring, polygon or feature
};

/// Decides for each area by the rings that it is in. One walk over all areas from the outside crosses each wall of a
/// spanning tree once in each direction, and changes the membership only in the rings that walk along this wall.
/// `walls`: of each of the input's segments; `areas`: their number, all of which can be reached from `outside` across
/// walls. The input must be as repair() leaves it.
[[nodiscard]] PolygonCover cover_by_polygons(const Pslg& pslg, const std::vector<Wall>& walls, std::size_t areas,
                                             AreaId outside);

}  // namespace driftmesh
