#include "gis/transverse_mercator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gis/conformal_latitude.hpp"

namespace driftmesh {
namespace {

constexpr double kScale = 0.9996;
constexpr double kFalseEasting = 500'000, kFalseNorthing = 10'000'000;

constexpr double kN = kFlattening / (2 - kFlattening);  // the third flattening

/// Karney (2011), equation 14: the radius of the sphere with the same meridians.
constexpr double rectifying_radius() {
  constexpr double n2 = kN * kN;
  return kEquatorRadius / (1 + kN) * (1 + n2 * (1.0 / 4 + n2 * (1.0 / 64 + n2 / 256)));
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

constexpr double kMeters = kScale * rectifying_radius();

struct OnSphere {
  double xi, eta;  // northing and easting on the sphere with the same meridians, in radians
};

/// Adds to `sum` what equation 11 corrects at a place on the sphere, times `sign`.
OnSphere corrected(OnSphere sum, const OnSphere& at, double sign) {
  constexpr std::array<double, 6> alpha = series();
  for (std::size_t j = 0; j < alpha.size(); ++j) {
    const double k = 2 * static_cast<double>(j + 1);
    sum.xi += sign * alpha[j] * std::sin(k * at.xi) * std::cosh(k * at.eta);
    sum.eta += sign * alpha[j] * std::cos(k * at.xi) * std::sinh(k * at.eta);
  }
  return sum;
}

}  // namespace

std::string UtmZone::name() const {
  return "UTM zone " + std::to_string(number) + (north ? "N" : "S");
}

UtmZone utm_zone_of(double longitude, double latitude) {
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);  // from -180, to 180 exclusive
  return {std::clamp(static_cast<int>((turned + 180) / 6) + 1, 1, 60), latitude >= 0};
}

std::optional<UtmZone> utm_zone_named(std::string_view name) {
  for (int number = 1; number <= 60; ++number)
    for (const bool north : {true, false})
      if (const UtmZone zone{number, north}; zone.name() == name) return zone;
  return std::nullopt;
}

std::optional<UtmZone> utm_zone_of_epsg(int code) {
  const UtmZone zone{code % 100, code < 32'700};
  if (zone.number < 1 || zone.number > 60 || zone.epsg() != code) return std::nullopt;
  return zone;
}

Point utm(double longitude, double latitude, const UtmZone& zone) {
  const double from_meridian = kRadians * std::remainder(longitude - zone.central_meridian(), 360);
  const double tangent = conformal_tangent(std::tan(kRadians * latitude));
  // On the sphere, equations 10 and 11.
  const double cosine = std::cos(from_meridian);
  const OnSphere sphere{std::atan2(tangent, cosine), std::asinh(std::sin(from_meridian) / std::hypot(tangent, cosine))};
  const OnSphere plane = corrected(sphere, sphere, 1);
  return {kFalseEasting + kMeters * plane.eta, (zone.north ? 0 : kFalseNorthing) + kMeters * plane.xi};
}

/// The series of the other direction is not needed: corrections are so small that the place on the sphere is a fixed
/// point, approached by two to three digits a step.
Point geographic(const Point& place, const UtmZone& zone) {
  const OnSphere target{(place.y - (zone.north ? 0 : kFalseNorthing)) / kMeters, (place.x - kFalseEasting) / kMeters};
  OnSphere sphere = target;
  for (int i = 0; i < 8; ++i) sphere = corrected(target, sphere, -1);
  const double cosine = std::cos(sphere.xi), sine = std::sinh(sphere.eta);
  const double conformal = std::sin(sphere.xi) / std::hypot(sine, cosine);
  return {zone.central_meridian() + std::atan2(sine, cosine) / kRadians,
          std::atan(tangent_of_conformal(conformal)) / kRadians};
}

}  // namespace driftmesh
