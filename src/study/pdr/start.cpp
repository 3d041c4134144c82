#include "study/pdr/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "driftmesh/error.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/refiner.hpp"

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

Box box_of(const Triangulation& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    if (!t.alive()) continue;
    for (const VertexId v : t.vertex) box.extend(mesh.points[v]);
  }
  return box;
}

double largest_radius(const Triangulation& mesh) {
  double largest = 0;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const Point& a = mesh.corner(t, 0);
    const Point center = circumcenter(a, mesh.corner(t, 1), mesh.corner(t, 2));
    largest = std::max(largest, std::sqrt(squared_distance(a, center)));
  }
  return largest;
}

}  // namespace

Lattice start(Triangulation& mesh, const QualityBounds& bounds, std::int32_t ranks) {
  if (!(bounds.max_area > 0) || bounds.size != nullptr || !(bounds.min_angle > 0))
    throw Error("partially coupled refinement needs one bound on area everywhere, and one on angles");
  const Box box = box_of(mesh);
  const double side = std::sqrt((box.high.x - box.low.x) * (box.high.y - box.low.y) / (kCellsPerRank * ranks));
  const double radius = side / kSidePerRadius;
  QualityBounds coarse = bounds;
  coarse.max_area = std::max(kCoarsest * bounds.max_area, radius * radius / kSquaredRadiusPerArea);
  Refiner(mesh, coarse).refine();
  return {box.low, box.high, std::max(side, kSidePerRadius * largest_radius(mesh)), ranks};
}

}  // namespace driftmesh::pdr
