#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/names.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh {

/// A planar straight line graph: the points, segments, holes and regions that describe a domain to be meshed. The
/// domain is what the segments enclose, without the holes; without segments it is the convex hull of the points.
/// Segments may also lie inside the domain, and become edges of the mesh there.
///
/// Plain data, as in Triangle's .poly files. Nothing is checked here: before meshing, repair() fixes duplicates,
/// overlaps and crossings, and refuses indices and coordinates out of range. Coordinates are in a unit of the user's
/// choice, areas in its square; see Point for their range.
struct Pslg {
  struct Segment {
    std::int32_t a = 0;       ///< index into points
    std::int32_t b = 0;       ///< index into points
    std::int32_t marker = 0;  ///< passed on to the subsegments that the segment is split into; any value
    friend bool operator==(const Segment&, const Segment&) = default;
  };
  /// A seed of a region: everything reachable from `at` without crossing a segment.
  struct Region {
    Point at;              ///< not on a segment
    double attribute = 0;  ///< passed on to the triangles of the region; any value
    double max_area = 0;   ///< bound on the area of its triangles; <= 0: none of its own
    friend bool operator==(const Region&, const Region&) = default;
  };

  std::vector<Point> points;
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point
  std::vector<double> attributes;           ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;    ///< >= 0; the mesher interpolates them at the points that it adds
  std::vector<Segment> segments;
  std::vector<Point> holes;       ///< each removes everything reachable from it without crossing a segment
  std::vector<Region> regions;    ///< if several seeds lie in one region, the last one counts
  Names names;                    ///< of markers and of the attributes of regions
  std::int32_t first_number = 1;  ///< number of points[0] in files and messages: 0 or 1
};

}  // namespace driftmesh
