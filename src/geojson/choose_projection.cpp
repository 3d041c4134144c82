#include "geojson/choose_projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"
#include "geometry/box.hpp"

namespace driftmesh {
namespace {

constexpr double kFarthestFromMeridian = 40, kFarthest = 60;  // degrees
constexpr double kRadians = std::numbers::pi / 180;

/// A direction in space.
struct Direction {
  double x = 0, y = 0, z = 0;

  explicit Direction(const Point& place)
      : x(std::cos(kRadians * place.y) * std::cos(kRadians * place.x)),
        y(std::cos(kRadians * place.y) * std::sin(kRadians * place.x)),
        z(std::sin(kRadians * place.y)) {}
};

/// Degrees between two places, as on a sphere.
double way_between(const Point& a, const Point& b) {
  const Direction p(a), q(b);
  const double across = std::hypot(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
  return std::atan2(across, p.x * q.x + p.y * q.y + p.z * q.z) / kRadians;
}

double farthest_from(const Point& center, std::span<const Point> places) {
  double farthest = 0;
  for (const Point& place : places) farthest = std::max(farthest, way_between(center, place));
  return farthest;
}

/// The middle of the longitudes and latitudes, in whole degrees, or a pole if the places are nearer to that.
Point center_for(const Box& box, std::span<const Point> places, bool around_pole) {
  const Point middle{std::round((box.low.x + box.high.x) / 2), std::round((box.low.y + box.high.y) / 2)};
  const Point pole{0, middle.y < 0 ? -90.0 : 90.0};
  return around_pole || farthest_from(pole, places) <= farthest_from(middle, places) ? pole : middle;
}

bool serves(const UtmZone& zone, const Box& box) {
  const double off = std::remainder((box.low.x + box.high.x) / 2 - zone.central_meridian(), 360);
  return box.low.y >= -80 && box.high.y <= 84 && (box.high.x - box.low.x) / 2 + std::abs(off) <= kFarthestFromMeridian;
}

}  // namespace

Projection choose_projection(std::span<const Point> places, bool around_pole, const std::string& file) {
  const Box box = Box::of(places);
  const UtmZone zone = utm_zone_of((box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2);
  if (!around_pole && serves(zone, box)) return Projection(zone);
  const Point center = center_for(box, places, around_pole);
  if (farthest_from(center, places) <= kFarthest) return Projection(Stereographic(center));
  throw InputError({file},
                   around_pole
                       ? "goes all around the globe, and reaches more than 60 degrees from the pole, so that no "
                         "plane is true to scale"
                       : "reaches more than 60 degrees from its middle, so that no plane is true to scale",
                   "mesh a part of it");
}

Projection given_projection(const std::string& asked, std::span<const Point> places, bool around_pole,
                            const std::string& file) {
  if (asked.empty() || asked == "auto") return choose_projection(places, around_pole, file);
  const Projection plane = projection_named(asked).value();
  const auto zone = utm_zone_named(asked);
  const Point center = plane.geographic({Stereographic::kFalseOrigin, Stereographic::kFalseOrigin});
  const bool reaches_too_far =
      zone ? around_pole || !serves(*zone, Box::of(places)) : farthest_from(center, places) > kFarthest;
  if (!reaches_too_far) return plane;
  throw Keyed<InputError>(
      {file},
      zone ? "is not within 40 degrees of the meridian of " + asked + ", and between 80 degrees south and 84 north"
           : "is not within 60 degrees of the center of " + asked,
      "choose another one by {input.projection}");
}

}  // namespace driftmesh
