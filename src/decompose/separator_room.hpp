#pragma once

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The room that a straight separator needs: the rule that everything asks that makes or moves a separator.
///
/// Triangles between a separator and a wall beside it are no larger than the gap: along a length l at a distance d they
/// are about 3 l / d, while a wall that leaves the separator at a wide angle costs only the logarithm of its length. So
/// the room is what lies beside the separator, on either side, nearer than a hundredth of its length, and is seen from
/// the nearer one of its ends at less than 20 degrees: a hexagon with the separator as its diagonal. Nothing that the
/// separator does not meet may reach into it. Angles with what it meets are the caller's concern.
class SeparatorRoom {
 public:
  SeparatorRoom() = default;  ///< no separator: room without any height
  /// The room of the separator ab; a and b differ. `wanted`: a length, the height on either side as far as corners are
  /// concerned, if that is more.
  SeparatorRoom(const Point& a, const Point& b, double wanted = 0);

  /// The height on either side, for corners.
  [[nodiscard]] double height() const;
  [[nodiscard]] bool contains(const Point& corner) const;
  /// Whether some part of the wall uw is inside.
  [[nodiscard]] bool is_entered_by(const Point& u, const Point& w) const;

 private:
  /// Coordinates along the separator and across it, times its length.
  struct Place {
    double along, across;
  };
  [[nodiscard]] Place place_of(const Point& p) const;

  Point a_{0, 0};
  Point d_{0, 0};  // b - a
  double squared_length_ = 0;
  double height_ = 0, height_for_corners_ = 0;  // times the length
};

}  // namespace driftmesh
