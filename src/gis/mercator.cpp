#include "gis/mercator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftmesh {
namespace {

/// The latitude whose conformal latitude this is, in radians: a fixed point, approached by two digits a step.
double latitude_of_conformal(double conformal) {
  constexpr double kOfEllipsoid = 1 / 298.257223563;  // its flattening
  const double eccentricity = std::sqrt(kOfEllipsoid * (2 - kOfEllipsoid));
  double latitude = conformal;
  for (int i = 0; i < 8; ++i) {
    const double sine = eccentricity * std::sin(latitude);
    latitude = std::atan(std::sinh(std::asinh(std::tan(conformal)) + eccentricity * std::atanh(sine)));
  }
  return latitude;
}

}  // namespace

std::optional<Mercator> mercator_of_code(int code) {
  constexpr std::array<int, 5> kWebCodes{3857, 3785, 900913, 102100, 102113};
  if (code == 3395 || code == 54004) return Mercator::kWorld;
  if (std::ranges::find(kWebCodes, code) != kWebCodes.end()) return Mercator::kWeb;
  return std::nullopt;
}

Point geographic(const Point& place, Mercator projection) {
  constexpr double kEquator = 6'378'137;  // its radius
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double conformal = std::atan(std::sinh(place.y / kEquator));
  const double latitude = projection == Mercator::kWeb ? conformal : latitude_of_conformal(conformal);
  return {place.x / kEquator * kDegrees, latitude * kDegrees};
}

}  // namespace driftmesh
