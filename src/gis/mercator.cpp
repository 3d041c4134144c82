#include "gis/mercator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gis/conformal_latitude.hpp"

namespace driftmesh {

std::optional<Mercator> mercator_of_code(int code) {
  constexpr std::array<int, 5> kWebCodes{3857, 3785, 900913, 102100, 102113};
  if (code == 3395 || code == 54004) return Mercator::kWorld;
  if (std::ranges::find(kWebCodes, code) != kWebCodes.end()) return Mercator::kWeb;
  return std::nullopt;
}

Point geographic(const Point& place, Mercator projection) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double conformal = std::sinh(place.y / kEquatorRadius);
  const double latitude = std::atan(projection == Mercator::kWeb ? conformal : tangent_of_conformal(conformal));
  return {place.x / kEquatorRadius * kDegrees, latitude * kDegrees};
}

}  // namespace driftmesh
