#pragma once

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The stereographic projection of the ellipsoid WGS 84 around a center, which is at (10,000 km, 10,000 km): with y to
/// the north there, or at a pole along the meridian of the center (to it at the south pole, away from it at the north
/// pole). Conformal: angles are those on the ellipsoid. True to scale at the center; lengths are 1.07 times as long 30
/// degrees away from it, and 1.33 times at 60 degrees (Snyder, Map Projections: a Working Manual, USGS 1987, equations
/// 21-24 to 21-38).
class Stereographic {
 public:
  /// Of both coordinates, in meters: so that they are positive, and about as precise everywhere.
  static constexpr double kFalseOrigin = 10'000'000;

  /// Longitude and latitude, in degrees.
  explicit Stereographic(const Point& center);

  [[nodiscard]] const Point& center() const { return center_; }

  /// Meters of a place in degrees, which must not be opposite of the center.
  [[nodiscard]] Point plane(const Point& place) const;
  /// The inverse. The longitude is within 180 degrees of the center's; that of a pole is the center's.
  [[nodiscard]] Point geographic(const Point& place) const;

 private:
  Point center_;
  double sine_, cosine_;  // those of the center's conformal latitude
  double diameter_;       // the sphere's, so that the center is true to scale
};

}  // namespace driftmesh
