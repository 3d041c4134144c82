#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "geometry/box_tree.hpp"
#include "verify/chains.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {

/// Where doubles leave no room for another point, judged by the mesh alone.
///
/// Where a point would encroach upon a subsegment, refinement splits that subsegment instead. This can fail, and the
/// subsegment is called stuck, if its rounded midpoint is one of its ends, or if the third corner of a triangle beside
/// it is within two spacings of doubles of its line: rounding may put the midpoint beyond that corner. The corner must
/// be on a segment itself, so that it cannot be deleted, unless the subsegment is shorter than 256 spacings. A
/// subsegment is also stuck if it is at most 2^-60 of its segment: names of points on segments go no deeper, and where
/// a segment ends at the origin, doubles do.
///
/// A triangle cannot be helped if none of its edges is longer than two spacings, or if the point that would help it
/// lies in the diametral circle of a stuck subsegment or beyond it, as seen from one of the triangle's corners.
class Room {
 public:
  Room(const Mesh& mesh, const Chains& chains);

  using Triangle = std::array<Point, 3>;
  /// Whether nothing can be done about an angle of a triangle below `min_angle` degrees: for its off-center.
  [[nodiscard]] bool none_for_angle(const Triangle& triangle, double min_angle) const;
  /// Whether nothing can be done about the area of a triangle: for its circumcenter.
  [[nodiscard]] bool none_for_area(const Triangle& triangle) const;

 private:
  struct Segment {
    Point a, b;
  };

  void add_stuck(std::int32_t subsegment, long double shortest);
  [[nodiscard]] bool is_stuck(std::int32_t subsegment) const;
  [[nodiscard]] bool none_for(const Triangle& triangle, double most_height) const;

  const Mesh& mesh_;
  const Subsegments& subsegments_;
  std::vector<Segment> stuck_;
  BoxTree tree_;  // diametral circles of stuck_
};

}  // namespace driftmesh
