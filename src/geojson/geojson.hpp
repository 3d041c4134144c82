#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/names.hpp"
#include "geometry/polygon.hpp"

namespace driftmesh {

/// What a GeoJSON file has (RFC 7946), with the properties that matter here.
struct GeoFeatures {
  /// A region that a polygon stands for (see Pslg::Region).
  struct Region {
    double attribute = 0;
    double max_area = 0;  ///< 0: none
  };
  struct Polygon {
    std::size_t feature = 0;  ///< counted from 1, for messages
    std::vector<PolygonRing>
        rings;  ///< the outer one, then holes; each has at least three corners, none twice in a row
    std::optional<std::int32_t> marker;
    std::optional<Region> region;
  };
  struct Line {
    std::vector<Point> points;  ///< at least two, none twice in a row
    std::int32_t marker = 0;
  };

  std::vector<Polygon> polygons;
  std::vector<Line> lines;
  std::vector<Point> points;
  Names names;             ///< names for markers and regions
  bool in_degrees = true;  ///< longitudes and latitudes, as the format has it, unless an old "crs" says otherwise; also
                           ///< what was in Mercator's projection
  bool in_meters = false;  ///< those of a plane, by what the "crs" names
  std::string projection;  ///< the UTM zone that the "crs" names by its EPSG code; empty: none
  std::string system;      ///< what the "crs" names; empty: nothing
  std::vector<std::string> warnings;

  /// Whether it is known what the numbers of positions mean.
  [[nodiscard]] bool knows_system() const { return in_degrees || in_meters || !projection.empty() || system.empty(); }
};

// The markers that the property "boundary" stands for: "land", "island", "open".
inline constexpr std::int32_t kGeoLand = 1;
inline constexpr std::int32_t kGeoIsland = 2;
inline constexpr std::int32_t kGeoOpen = 3;

/// Throws InputError that names the line of a fault in the syntax, and the feature of any other.
[[nodiscard]] GeoFeatures parse_geojson(const std::string& file, std::string_view text);

}  // namespace driftmesh
