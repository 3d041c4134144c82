#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/names.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh {

/// A planar straight line graph: the points, segments, polygons, holes and regions that describe a domain to be meshed.
///
/// With polygons, the domain is their union, whatever they touch, overlap or cross, and all other segments are
/// constraints that bound nothing. Without polygons, the domain is what the segments enclose, as in Triangle's .poly
/// files; without segments, it is the convex hull of the points. Either way, what the hole points reach is removed.
/// All segments inside the domain become edges of the mesh.
///
/// Plain data. Nothing is checked here: before meshing, repair() fixes duplicates, overlaps and crossings, and refuses
/// indices and coordinates out of range. Coordinates are in a unit of the user's choice, areas in its square; see Point
/// for their range.
///
/// \code
/// driftmesh::Pslg square;
/// square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.6, 0.5}};
/// square.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 2}, {3, 0, 2}, {4, 5, 3}};  // the last one is a constraint
/// square.regions = {{.at = {0.1, 0.1}, .attribute = 7, .max_area = 1e-3}};
/// assert(driftmesh::mesh(square).regions[0] == 7);
/// \endcode
struct Pslg {
  struct Segment {
    std::int32_t a = 0;       ///< index into points
    std::int32_t b = 0;       ///< index into points
    std::int32_t marker = 0;  ///< passed on to the subsegments that the segment is split into; any value
    friend bool operator==(const Segment&, const Segment&) = default;
  };
  /// A region: everything reachable from the seed `at` without crossing a segment, or, if polygons name the region,
  /// these polygons.
  struct Region {
    Point at;              ///< not on a segment; has no meaning if a polygon names the region
    double attribute = 0;  ///< passed on to the triangles of the region; any value
    double max_area = 0;   ///< bound on the area of its triangles; <= 0: none of its own
    friend bool operator==(const Region&, const Region&) = default;
  };
  /// The indices of a ring's corners in `points`, in either direction, without the first one again at the end. Each
  /// corner and the next, and the last and the first, are the ends of a segment. A ring may touch, cross and repeat
  /// itself: its interior is what lies an odd number of times inside (even-odd rule), so that an edge that it walks
  /// twice bounds nothing.
  using Ring = std::vector<std::int32_t>;
  /// The interior of the first ring, without the interiors of all others. These may reach outside the first one and
  /// overlap each other.
  struct Polygon {
    std::vector<Ring> rings;
    std::int32_t region = -1;  ///< index into regions; -1: none. Where polygons overlap, the last that has one counts
    std::int32_t feature = 0;  ///< its number in messages; equal for the parts of a multipolygon; 0: none
    friend bool operator==(const Polygon&, const Polygon&) = default;
  };

  std::vector<Point> points;
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point
  std::vector<double> attributes;           ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;    ///< >= 0; the mesher interpolates them at the points that it adds
  std::vector<Segment> segments;
  std::vector<Point> holes;       ///< each removes everything reachable from it without crossing a segment
  std::vector<Region> regions;    ///< if several seeds lie in one region, the last one counts, before polygons
  Names names;                    ///< names for markers and for the attributes of regions
  std::int32_t first_number = 1;  ///< number of points[0] in files and messages: 0 or 1
  std::vector<Polygon> polygons;  ///< none: the segments bound the domain
};

}  // namespace driftmesh
