#pragma once

#include <numbers>

namespace driftmesh {

inline constexpr double kRadians = std::numbers::pi / 180;  ///< in a degree

/// The ellipsoid WGS 84.
inline constexpr double kEquatorRadius = 6'378'137;  ///< meters
inline constexpr double kFlattening = 1 / 298.257223563;

/// The tangent of the conformal latitude, that of the place on a sphere onto which the ellipsoid is mapped with all its
/// angles, from the tangent of the latitude (Karney, Transverse Mercator with an accuracy of a few nanometers, J.
/// Geodesy 85, 2011, equations 7 to 9).
[[nodiscard]] double conformal_tangent(double tangent);

/// The inverse, by Newton's method (equations 19 to 21).
[[nodiscard]] double tangent_of_conformal(double conformal);

}  // namespace driftmesh
