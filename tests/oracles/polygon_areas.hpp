#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

// The areas that sets of polygons cover, from the raw rings: the plane is cut into slabs at every corner and crossing,
// edges are sorted in each, and parities counted from left to right. All decisions are exact, in integers.

namespace driftmesh::oracles {

/// Differences are at most 2^52.
struct GridPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};
using GridRing = std::vector<GridPoint>;  ///< the first corner is not repeated at the end

[[nodiscard]] inline GridRing rectangle(std::int64_t left, std::int64_t bottom, std::int64_t right, std::int64_t top) {
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

/// The interior of the first ring, by even-odd, without those of the others.
struct GridPolygon {
  std::vector<GridRing> rings;
  std::optional<double> region;
};

struct PolygonAreas {
  long double total = 0;
  /// Areas by the region of the last polygon with a region there; 0: places without.
  std::map<double, long double> regions;
};

/// The areas of the union, in squared units of the grid, up to a relative rounding of 1e-17 of the box around it.
[[nodiscard]] PolygonAreas covered_areas(const std::vector<GridPolygon>& polygons);

}  // namespace driftmesh::oracles
