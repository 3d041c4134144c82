#include "geojson/transverse_mercator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftmesh {
namespace {

// WGS 84.
constexpr double kRadius = 6'378'137;
constexpr double kFlattening = 1 / 298.257223563;
constexpr double kScale = 0.9996;
constexpr double kFalseEasting = 500'000, kFalseNorthing = 10'000'000;

constexpr double kN = kFlattening / (2 - kFlattening);  // the third flattening

/// Karney (2011), equation 14: the radius of the sphere with the same meridians.
constexpr double rectifying_radius() {
  constexpr double n2 = kN * kN;
  return kRadius / (1 + kN) * (1 + n2 * (1.0 / 4 + n2 * (1.0 / 64 + n2 / 256)));
}

/// Equation 35: alpha 1 to 6.
constexpr std::array<double, 6> series() {
  constexpr double n = kN, n2 = n * n, n3 = n2 * n, n4 = n3 * n, n5 = n4 * n, n6 = n5 * n;
  return {n / 2 - 2 * n2 / 3 + 5 * n3 / 16 + 41 * n4 / 180 - 127 * n5 / 288 + 7891 * n6 / 37800,
          13 * n2 / 48 - 3 * n3 / 5 + 557 * n4 / 1440 + 281 * n5 / 630 - 1983433 * n6 / 1935360,
          61 * n3 / 240 - 103 * n4 / 140 + 15061 * n5 / 26880 + 167603 * n6 / 181440,
          49561 * n4 / 161280 - 179 * n5 / 168 + 6601661 * n6 / 7257600,
          34729 * n5 / 80640 - 3418889 * n6 / 1995840,
          212378941 * n6 / 319334400};
}

/// Equations 7 to 9: the tangent of the conformal latitude.
double conformal_tangent(double tangent) {
  const double eccentricity = std::sqrt(kFlattening * (2 - kFlattening));
  const double sigma = std::sinh(eccentricity * std::atanh(eccentricity * tangent / std::hypot(1, tangent)));
  return tangent * std::hypot(1, sigma) - sigma * std::hypot(1, tangent);
}

}  // namespace

std::string UtmZone::name() const {
  return "UTM zone " + std::to_string(number) + (north ? "N" : "S");
}

UtmZone utm_zone_of(double longitude, double latitude) {
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);  // from -180, to 180 exclusive
  return {std::clamp(static_cast<int>((turned + 180) / 6) + 1, 1, 60), latitude >= 0};
}

Point utm(double longitude, double latitude, const UtmZone& zone) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double from_meridian = kRadians * std::remainder(longitude - zone.central_meridian(), 360);
  const double tangent = conformal_tangent(std::tan(kRadians * latitude));
  // On the sphere, equations 10 and 11.
  const double cosine = std::cos(from_meridian);
  const double xi = std::atan2(tangent, cosine);
  const double eta = std::asinh(std::sin(from_meridian) / std::hypot(tangent, cosine));
  double northing = xi, easting = eta;
  constexpr std::array<double, 6> alpha = series();
  for (std::size_t j = 0; j < alpha.size(); ++j) {
    const double k = 2 * static_cast<double>(j + 1);
    northing += alpha[j] * std::sin(k * xi) * std::cosh(k * eta);
    easting += alpha[j] * std::cos(k * xi) * std::sinh(k * eta);
  }
  constexpr double kMeters = kScale * rectifying_radius();
  return {kFalseEasting + kMeters * easting, (zone.north ? 0 : kFalseNorthing) + kMeters * northing};
}

}  // namespace driftmesh
