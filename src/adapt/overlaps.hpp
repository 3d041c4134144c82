#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adapt/locator.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::adapt {

/// The part that an old triangle has in common with a new one. Its origin is the first corner of the new one, so that
/// rounding is small beside the triangle, however far from 0 both are.
struct Overlap {
  TriangleId new_triangle{};
  std::uint32_t first = 0, end = 0;  ///< its corners among those of all
  double area = 0;
};

/// All overlaps of an old triangle.
struct Overlaps {
  TriangleId old_triangle{};
  double correction = 1;  ///< the triangle's area over the sum of its overlaps: 1 but for rounding
  std::vector<Overlap> list;
  std::vector<Point> corners;  ///< convex polygons, counterclockwise, each as seen from its origin

  [[nodiscard]] std::span<const Point> polygon(const Overlap& o) const {
    return std::span(corners).subspan(o.first, o.end - o.first);
  }
};

/// Finds the new triangles that overlap one old triangle after another. Both meshes cover the same polygon. Overlaps
/// are rounded: those of an old triangle sum up to its area but for some 1e-15 of its size.
class OverlapSearch {
 public:
  /// The meshes outlive the object.
  OverlapSearch(const Triangulation& old_mesh, const Triangulation& new_mesh);

  /// From the new triangle at the centroid on, across the edges on which both sides overlap the old one; fast if the
  /// old one before it was near. Puts them in place of what is there, with a correction of 1.
  void find(TriangleId old_triangle, Overlaps& found);

 private:
  /// What two triangles have in common. Two triangles have at most six corners in common but for rounding: where that
  /// puts corners of one side on both sides of another, each of three cuts makes at most half as many again, from 3 to
  /// 4, 6 and 9.
  class CommonPolygon {
   public:
    static constexpr std::size_t kMostCorners = 9;

    [[nodiscard]] const Point* begin() const { return corners_.data(); }
    [[nodiscard]] const Point* end() const { return corners_.data() + size_; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const Point& operator[](std::size_t i) const { return corners_[i]; }
    /// The edge of the new triangle on which the side from corner i to the next one is.
    [[nodiscard]] int edge_at(std::size_t i) const { return edge_[i]; }
    [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 < size_ ? i + 1 : 0; }
    void clear() { size_ = 0; }
    void push_back(const Point& p, int edge);

   private:
    std::array<Point, kMostCorners> corners_;
    std::array<int, kMostCorners> edge_;
    std::size_t size_ = 0;
  };

  static void cut_off(const CommonPolygon& polygon, const Point& a, const Point& b, CommonPolygon& kept);
  static double area_of(const CommonPolygon& polygon);
  const CommonPolygon& common(const CornerPoints& old_triangle, TriangleId t);
  void enter(TriangleId t);

  const Triangulation& old_mesh_;
  const Triangulation& new_mesh_;
  Locator locator_;
  IdVector<TriangleId, std::uint32_t> seen_;  // the last search that came to each new triangle
  std::uint32_t search_ = 0;
  std::vector<TriangleId> open_;
  std::array<CommonPolygon, 2> polygons_;
};

}  // namespace driftmesh::adapt
