#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// The part that a new triangle of a subdomain has in common with an old one. Its origin is the first corner of the new
/// one, so that rounding is small beside the triangle, however far from 0 both are.
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
  std::vector<Point> corners;     ///< convex polygons, counterclockwise, each as seen from its origin

  [[nodiscard]] std::span<const Point> polygon(const Overlap& o) const {
    return std::span(corners).subspan(o.first, o.end - o.first);
  }
};

/// Finds all overlaps of new triangles that `is_new` names with old ones, some at a time. Both meshes cover the same
/// polygon. Overlaps are rounded: those of an old triangle sum up to its area but for some 1e-15 of its size.
class OverlapFinder {
 public:
  /// The meshes outlive the object.
  OverlapFinder(const Triangulation& old_mesh, const Triangulation& new_mesh,
                const std::function<bool(TriangleId)>& is_new);
  ~OverlapFinder();

  /// Puts the next ones, all of a new triangle or none, into `found` in place of what is there, at least `most` of them
  /// if there are as many. False, and nothing is put there: no triangles are left.
  bool find(std::size_t most, OverlapList& found);

 private:
  class Search;
  void enter(TriangleId t);
  bool next_triangle();

  const Triangulation& new_mesh_;
  std::unique_ptr<Search> search_;
  // From each triangle to one beside it, so that the search finds the next one near the last one.
  IdVector<TriangleId, bool> is_left_;
  std::size_t first_ = 0;  // those before have been entered
  std::vector<TriangleId> open_;
};

}  // namespace driftmesh::adapt
