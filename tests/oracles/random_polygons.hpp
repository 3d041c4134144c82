#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "oracles/polygon_areas.hpp"

namespace driftmesh::oracles {

/// A random set of polygons, on a grid whose unit is a power of two.
struct RandomPolygons {
  std::vector<GridPolygon> polygons;
  GridPoint origin;  ///< the grid's, in units
  double unit = 1;
  bool general = false;  ///< valid polygons that overlap, no three lines of which meet; otherwise flawed in all ways
};

/// Small sets: half of them with corners on few grid points, so that all in Trait occurs often; half of valid
/// polygons, with holes, that overlap each other. In meters as in UTM, around 0, and as small as degrees are.
[[nodiscard]] RandomPolygons make_random_polygons(std::uint64_t seed);

/// What a set can be hard for.
enum class Trait : std::uint8_t {
  polygons_overlap,
  polygons_touch,
  edges_coincide,       ///< two polygons share an edge
  over_a_hole,          ///< a polygon with a corner in another one's hole
  repeated_corner,      ///< in a row
  ring_touches_itself,  ///< a corner twice, or on another edge
  ring_crosses_itself,
  keyhole,  ///< an edge walked twice
  hole_crosses,
  hole_touches,
  hole_leaves,  ///< has a corner outside its polygon
  holes_overlap,
  holes_touch,
};
inline constexpr std::size_t kTraits = 13;
[[nodiscard]] const char* trait_name(Trait trait);

/// Which of them a set has (exact).
[[nodiscard]] std::array<bool, kTraits> traits_of(const std::vector<GridPolygon>& polygons);

/// The set as GeoJSON in a projected system, with the regions as properties: coordinates have all their digits.
[[nodiscard]] std::string geojson_of(const RandomPolygons& set);

}  // namespace driftmesh::oracles
