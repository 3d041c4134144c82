#pragma once

namespace driftmesh {

/// A point in the plane. Input coordinates must be 0 or of magnitude between 7.6e-37 and 1.7e72, the range in which the
/// geometric predicates are exact.
///
/// \code
/// const driftmesh::Point p{.x = 0.25, .y = 1}, q{0.25, 1};
/// assert(p == q);
/// \endcode
struct Point {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

}  // namespace driftmesh
