#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// The part that a new triangle of a subdomain has in common with an old one.
struct Overlap {
  TriangleId old_triangle{};
  TriangleId new_triangle{};
  std::uint32_t first = 0, end = 0;  ///< its corners among those of all
  double area = 0;
};

struct OverlapList {
  /// Two triangles have at most six corners in common but for rounding: where that puts corners of one side on both
  /// sides of another, each of three cuts makes at most half as many again, from 3 to 4, 6 and 9.
  static constexpr std::size_t kMostCorners = 9;

  std::vector<Overlap> overlaps;  ///< those of a new triangle behind each other
  std::vector<Point> corners;     ///< convex polygons, counterclockwise

  [[nodiscard]] std::span<const Point> polygon(const Overlap& o) const {
    return std::span(corners).subspan(o.first, o.end - o.first);
  }
};

/// Finds all overlaps of new triangles that `is_new` names with old ones, and puts them into `found` in place of what
/// is there. Both meshes cover the same polygon. Overlaps are rounded: those of an old triangle sum up to its area but
/// for some 1e-15 of its size.
void find_overlaps(const Triangulation& old_mesh, const Triangulation& new_mesh,
                   const std::function<bool(TriangleId)>& is_new, OverlapList& found);

}  // namespace driftmesh::adapt
