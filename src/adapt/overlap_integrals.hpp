#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "adapt/lineage.hpp"
#include "adapt/overlaps.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {

using Weights = std::array<double, 3>;

[[nodiscard]] inline double area_of(const Triangulation& mesh, TriangleId t) {
  return signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// What an overlap adds to integrals over the new triangle.
class Share {
 public:
  Share(const Overlaps& overlaps, const Overlap& overlap, const Lineage::Change& change)
      : Share(overlaps, overlap, change, overlaps.polygon(overlap), change.new_mesh.corner(overlap.new_triangle, 0)) {}

  /// The integrals of the function that is linear in the old triangle, with these values at its corners, times that of
  /// each corner of the new one.
  [[nodiscard]] Weights moments(const std::array<double, 3>& at_old) const {
    double f = 0, fx = 0, fy = 0;  // at the origin, and how it changes
    for (std::size_t i = 0; i < 3; ++i) {
      f += in_old_.at[i] * at_old[i];
      fx += in_old_.dx[i] * at_old[i];
      fy += in_old_.dy[i] * at_old[i];
    }
    const double all = f * area_ + fx * x_ + fy * y_;
    const double by_x = f * x_ + fx * xx_ + fy * xy_, by_y = f * y_ + fx * xy_ + fy * yy_;
    Weights moments{};
    for (std::size_t k = 0; k < 3; ++k) moments[k] = in_new_.at[k] * all + in_new_.dx[k] * by_x + in_new_.dy[k] * by_y;
    return moments;
  }

 private:
  /// The functions of the corners of a triangle, each 1 at one and 0 at the others: at a point, from which integrals
  /// are taken, and how they change from there.
  struct Corners {
    Weights at, dx, dy;
    Corners(const Triangulation& mesh, TriangleId t, const Point& origin, const Point& p) {
      const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
      const double each = 1 / rounded_cross(a, b, c);
      dx = {0, (c.y - a.y) * each, (a.y - b.y) * each};
      dy = {0, (a.x - c.x) * each, (b.x - a.x) * each};
      dx[0] = -dx[1] - dx[2];
      dy[0] = -dy[1] - dy[2];
      const double x = origin.x - a.x + p.x, y = origin.y - a.y + p.y;
      at = {0, dx[1] * x + dy[1] * y, dx[2] * x + dy[2] * y};
      at[0] = 1 - at[1] - at[2];
    }
  };

  Share(const Overlaps& overlaps, const Overlap& overlap, const Lineage::Change& change, std::span<const Point> polygon,
        const Point& origin)
      : in_old_(change.old_mesh, overlaps.old_triangle, origin, polygon[0]),
        in_new_(change.new_mesh, overlap.new_triangle, origin, polygon[0]) {
    for (std::size_t i = 2; i < polygon.size(); ++i)
      add_triangle(polygon[i - 1], polygon[i], polygon[0], overlaps.correction);
  }

  void add_triangle(const Point& p, const Point& q, const Point& origin, double correction) {
    const double px = p.x - origin.x, py = p.y - origin.y, qx = q.x - origin.x, qy = q.y - origin.y;
    const double twice = correction * (px * qy - py * qx);
    area_ += twice / 2;
    x_ += twice / 6 * (px + qx);
    y_ += twice / 6 * (py + qy);
    xx_ += twice / 12 * (px * px + px * qx + qx * qx);
    xy_ += twice / 24 * (2 * px * py + px * qy + qx * py + 2 * qx * qy);
    yy_ += twice / 12 * (py * py + py * qy + qy * qy);
  }

  Corners in_old_, in_new_;
  double area_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;  // integrals of these over the overlap
};

/// Calls visit(overlaps) for each old triangle that is gone, with those new triangles that do not stay: others have
/// none but for rounding.
void visit_overlaps(const Lineage::Change& change, const std::function<void(const Overlaps&)>& visit);

}  // namespace driftmesh::adapt
