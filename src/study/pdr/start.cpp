#include <algorithm>
#include <cmath>

#include "driftmesh/error.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/refiner.hpp"
#include "study/pdr/part.hpp"

namespace driftmesh::pdr {
namespace {

/// Side of a cell over the largest circumradius r. A triangle of a cell has its circumcenter within r of it, a free
/// point stays within 3 r and so do the ends of a segment that it encroaches upon; where that is split, vertices within
/// 5 r are deleted, whose stars end within 7 r. Half a side is more than that.
constexpr double kSidePerRadius = 15;
constexpr double kCellsPerRank = 16;
/// The squared circumradius of a triangle is at most about this many times its area.
constexpr double kSquaredRadiusPerArea = 3;
/// The start is coarser than the bound: otherwise, nothing would be left to do at once.
constexpr double kCoarsest = 2;

/// Does visit(a, b, c) for the corners of each triangle.
template <class Visit>
void each_triangle(const Triangulation& mesh, const Visit& visit) {
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) visit(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

}  // namespace

Lattice start(Triangulation& mesh, const QualityBounds& bounds, std::int32_t ranks) {
  if (!(bounds.plain.area > 0) || SizeBounds(bounds).by_place() || !(bounds.min_angle > 0))
    throw Error("partially coupled refinement needs one bound on area everywhere, and one on angles");
  Box box;
  each_triangle(mesh, [&](const Point& a, const Point& b, const Point& c) {
    for (const Point* p : {&a, &b, &c}) box.extend(*p);
  });
  const double side = std::sqrt((box.high.x - box.low.x) * (box.high.y - box.low.y) / (kCellsPerRank * ranks));
  const double radius = side / kSidePerRadius;
  QualityBounds coarse = bounds;
  coarse.plain.area = std::max(kCoarsest * bounds.plain.area, radius * radius / kSquaredRadiusPerArea);
  Refiner(mesh, coarse).refine();
  double largest = 0;  // circumradius
  each_triangle(mesh, [&](const Point& a, const Point& b, const Point& c) {
    largest = std::max(largest, std::sqrt(squared_distance(a, circumcenter(a, b, c))));
  });
  return {box.low, box.high, std::max(side, kSidePerRadius * largest), ranks};
}

}  // namespace driftmesh::pdr
