#include "gis/stereographic.hpp"

#include <cmath>

#include "gis/conformal_latitude.hpp"

namespace driftmesh {
namespace {

constexpr double kE2 = kFlattening * (2 - kFlattening);

bool is_pole(double latitude) {
  return std::abs(latitude) == 90;
}

struct SineCosine {
  double sine, cosine;
};

/// Of the conformal latitude, in degrees; exact at poles.
SineCosine on_sphere(double latitude) {
  if (is_pole(latitude)) return {latitude > 0 ? 1.0 : -1.0, 0};
  const double tangent = conformal_tangent(std::tan(kRadians * latitude)), hypotenuse = std::hypot(1, tangent);
  return {tangent / hypotenuse, 1 / hypotenuse};
}

/// The radius of the parallel of a latitude, over that on the sphere of radius 1: at a pole, the limit.
double radius_of_sphere(double latitude) {
  if (is_pole(latitude)) {
    const double e = std::sqrt(kE2);
    return kEquatorRadius * std::pow((1 - e) / (1 + e), e / 2) / std::sqrt(1 - kE2);
  }
  const double sine = std::sin(kRadians * latitude);
  const double parallel = kEquatorRadius * std::cos(kRadians * latitude) / std::sqrt(1 - kE2 * sine * sine);
  return parallel / on_sphere(latitude).cosine;
}

}  // namespace

Stereographic::Stereographic(const Point& center)
    : center_(center),
      sine_(on_sphere(center.y).sine),
      cosine_(on_sphere(center.y).cosine),
      diameter_(2 * radius_of_sphere(center.y)) {}

Point Stereographic::plane(const Point& place) const {
  const auto [sine, cosine] = on_sphere(place.y);
  const double from_center = kRadians * std::remainder(place.x - center_.x, 360);
  const double toward = cosine * std::cos(from_center);
  const double scale = diameter_ / (1 + sine_ * sine + cosine_ * toward);
  return {kFalseOrigin + scale * cosine * std::sin(from_center),
          kFalseOrigin + scale * (cosine_ * sine - sine_ * toward)};
}

Point Stereographic::geographic(const Point& place) const {
  const double x = (place.x - kFalseOrigin) / diameter_, y = (place.y - kFalseOrigin) / diameter_;
  const double square = x * x + y * y;
  // A place on the sphere of radius 1: to the east and to the north of the center, and along its axis.
  const double factor = 2 / (1 + square), east = factor * x, north = factor * y, up = (1 - square) / (1 + square);
  const double toward = up * cosine_ - north * sine_, sine = north * cosine_ + up * sine_;
  const double cosine = std::hypot(east, toward);
  if (cosine == 0) return {center_.x, sine > 0 ? 90.0 : -90.0};
  return {center_.x + std::atan2(east, toward) / kRadians, std::atan(tangent_of_conformal(sine / cosine)) / kRadians};
}

}  // namespace driftmesh
