#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "driftmesh/point.hpp"
#include "gis/stereographic.hpp"
#include "gis/transverse_mercator.hpp"

namespace driftmesh {

/// A plane in meters in which a domain is meshed: a UTM zone, or a stereographic projection around the domain.
/// Conformal.
class Projection {
 public:
  explicit Projection(const UtmZone& zone) : kind_(zone) {}
  explicit Projection(const Stereographic& stereographic) : kind_(stereographic) {}

  [[nodiscard]] bool is_utm() const { return std::holds_alternative<UtmZone>(kind_); }
  /// "UTM zone 18N", or "stereographic at 0 90" with the longitude and the latitude of its center.
  [[nodiscard]] std::string name() const;
  /// The same for PROJ: "EPSG:32618", "+proj=stere +lat_0=90 ...".
  [[nodiscard]] std::string definition() const;

  /// The place of a longitude and a latitude in the plane.
  [[nodiscard]] Point plane(const Point& place) const;
  /// The inverse. Longitudes count on across the 180th meridian.
  [[nodiscard]] Point geographic(const Point& place) const;

 private:
  std::variant<UtmZone, Stereographic> kind_;
};

/// The projection of a name; none if it is not the name of one.
[[nodiscard]] std::optional<Projection> projection_named(std::string_view name);

}  // namespace driftmesh
