#include "gis/projection.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "base/from_chars.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kStereographic = "stereographic at ";

std::string shortest(double number) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

/// "12.5 84": two numbers with a blank between them, within their limits.
std::optional<Point> center_from(std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto number = [](std::string_view word, double& value) {
    const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
  };
  Point center;
  if (!number(text.substr(0, blank), center.x) || !number(text.substr(blank + 1), center.y)) return std::nullopt;
  if (!(std::abs(center.x) <= 360 && std::abs(center.y) <= 90)) return std::nullopt;
  return center;
}

}  // namespace

std::string Projection::name() const {
  if (const auto* const zone = std::get_if<UtmZone>(&kind_)) return zone->name();
  const Point& center = std::get<Stereographic>(kind_).center();
  return std::string(kStereographic) + shortest(center.x) + ' ' + shortest(center.y);
}

std::string Projection::definition() const {
  if (const auto* const zone = std::get_if<UtmZone>(&kind_)) return "EPSG:" + std::to_string(zone->epsg());
  const Point& center = std::get<Stereographic>(kind_).center();
  return "+proj=stere +lat_0=" + shortest(center.y) + " +lon_0=" + shortest(center.x) +
         " +k=1 +x_0=10000000 +y_0=10000000 +datum=WGS84 +units=m";
}

Point Projection::plane(const Point& place) const {
  if (const auto* const zone = std::get_if<UtmZone>(&kind_)) return utm(place.x, place.y, *zone);
  return std::get<Stereographic>(kind_).plane(place);
}

Point Projection::geographic(const Point& place) const {
  if (const auto* const zone = std::get_if<UtmZone>(&kind_)) return driftmesh::geographic(place, *zone);
  return std::get<Stereographic>(kind_).geographic(place);
}

std::optional<Projection> projection_named(std::string_view name) {
  if (const auto zone = utm_zone_named(name)) return Projection(*zone);
  if (!name.starts_with(kStereographic)) return std::nullopt;
  const auto center = center_from(name.substr(kStereographic.size()));
  return center ? std::optional(Projection(Stereographic(*center))) : std::nullopt;
}

}  // namespace driftmesh
