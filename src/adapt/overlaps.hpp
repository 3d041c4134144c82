#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/assert.hpp"
#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// What two triangles have in common: a convex polygon, counterclockwise.
class CommonPolygon {
 public:
  /// Six but for rounding: where that puts corners of one side on both sides of another, each of three cuts makes at
  /// most half as many again, from 3 to 4, 6 and 9.
  static constexpr std::size_t kMostCorners = 9;

  [[nodiscard]] const Point* begin() const { return corners_.data(); }
  [[nodiscard]] const Point* end() const { return corners_.data() + size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Point& operator[](std::size_t i) const { return corners_[i]; }
  void clear() { size_ = 0; }
  void push_back(const Point& p) {
    DM_ASSERT(size_ < kMostCorners);
    corners_[size_++] = p;
  }

 private:
  std::array<Point, kMostCorners> corners_;
  std::size_t size_ = 0;
};

/// The part that a new triangle of a subdomain has in common with an old one.
struct Overlap {
  TriangleId old_triangle{};
  TriangleId new_triangle{};
  CommonPolygon polygon;
  double area = 0;
};

/// Finds all overlaps of new triangles that `is_new` names with old ones, those of a new triangle behind each other,
/// and puts them into `found` in place of what is there. Both meshes cover the same polygon. Overlaps are rounded:
/// those of an old triangle sum up to its area but for some 1e-15 of its size.
void find_overlaps(const Triangulation& old_mesh, const Triangulation& new_mesh,
                   const std::function<bool(TriangleId)>& is_new, std::vector<Overlap>& found);

}  // namespace driftmesh::adapt
