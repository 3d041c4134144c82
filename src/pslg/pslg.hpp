#pragma once

#include <cstdint>
#include <vector>

#include "geometry/point.hpp"

namespace driftmesh {

/// A planar straight line graph: the input of the mesher. Plain data; nothing here is checked (see check and
/// repair).
struct Pslg {
  struct Segment {
    std::int32_t a = 0;  ///< index into points
    std::int32_t b = 0;  ///< index into points
    std::int32_t marker = 0;
    friend bool operator==(const Segment&, const Segment&) = default;
  };
  /// A seed of a region: everything reachable from `at` without crossing a segment.
  struct Region {
    Point at;
    double attribute = 0;
    double max_area = 0;  ///< <= 0: no bound of its own
    friend bool operator==(const Region&, const Region&) = default;
  };

  std::vector<Point> points;
  std::vector<std::int32_t> point_markers;  ///< empty, or one for each point
  std::vector<double> attributes;           ///< attributes_per_point values for each point, point by point
  std::int32_t attributes_per_point = 0;
  std::vector<Segment> segments;
  std::vector<Point> holes;
  std::vector<Region> regions;
  std::int32_t first_number = 1;  ///< what files and messages call points[0]: 0 or 1
};

}  // namespace driftmesh
