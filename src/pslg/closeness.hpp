#pragma once

#include <algorithm>
#include <cmath>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// When points count as equal: up to this distance, between points and from a point to a line.
///
/// Coordinates computed in double precision (a point put on a segment, an end that was transformed twice) are off by a
/// few units in the last place of the larger coordinate. No mesh can be represented inside such a gap, and none is
/// intended. The same holds near the origin, where doubles are dense, but the input that was computed is no more
/// exact: nothing counts as farther apart there than elsewhere in an input of the same extent around the origin.
class Closeness {
 public:
  static constexpr double kUlps = 4;

  /// `least`: the distance that counts as zero everywhere.
  explicit Closeness(double least = 0) : least_(least) {}
  /// For points in a box whose longer side has this length, where `snap` counts as zero, too.
  static Closeness within(double extent, double snap) { return Closeness(std::max(snap, rounding_at(extent / 2))); }

  /// The distance that counts as zero at `p`; for a segment, the larger of those at its ends.
  [[nodiscard]] double operator()(const Point& p) const {
    return std::max(least_, rounding_at(std::max(std::fabs(p.x), std::fabs(p.y))));
  }
  [[nodiscard]] double operator()(const Point& a, const Point& b) const { return std::max((*this)(a), (*this)(b)); }

 private:
  static double rounding_at(double coordinate) { return kUlps * 0x1p-52 * coordinate; }

  double least_;
};

enum class OnSegment { kNo, kExactly, kClosely };

/// Whether `p`, which is not close to a or b, lies in the interior of the segment from a to b, up to `margin`, which is
/// the closeness of the segment. A point within the margin of an end does not: otherwise each of two points could be on
/// the other's segment.
[[nodiscard]] OnSegment on_segment(const Point& p, const Point& a, const Point& b, double margin);

/// Whether the interiors of the segments ab and cd cross in one point (exact).
[[nodiscard]] bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d);

/// The point where segments that cross properly meet, computed in quadruple precision and rounded once; inside the
/// bounding boxes of both.
[[nodiscard]] Point crossing_point(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace driftmesh
