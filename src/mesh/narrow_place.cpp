#include "mesh/narrow_place.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// Measured at an angle bound of 20 degrees, for parallel segments of equal length: 2.2 to 3.7.
constexpr double kTrianglesPerWidth = 3;

/// The narrow place between ab and cd, if a piece of cd lies opposite to ab on its left.
std::optional<NarrowPlace> place_between(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double length = std::sqrt(squared_distance(a, b));
  const Point u{(b.x - a.x) / length, (b.y - a.y) / length};
  struct Foot {
    double along, width;
  };
  const auto foot = [&](const Point& p) {
    const double dx = p.x - a.x, dy = p.y - a.y;
    return Foot{dx * u.x + dy * u.y, u.x * dy - u.y * dx};
  };
  const Foot fc = foot(c), fd = foot(d);
  if (fc.along == fd.along) return {};
  const auto at = [&](double along) {
    return Foot{along, fc.width + (along - fc.along) / (fd.along - fc.along) * (fd.width - fc.width)};
  };
  const Foot first = at(std::clamp(std::min(fc.along, fd.along), 0.0, length));
  const Foot last = at(std::clamp(std::max(fc.along, fd.along), 0.0, length));
  const auto [near, far] = first.width < last.width ? std::pair(first, last) : std::pair(last, first);
  const double overlap = last.along - first.along;
  if (!(overlap > 0) || !(near.width > 0)) return {};
  // The integral of 1 / width.
  const double growth = far.width / near.width - 1;
  const double widths = overlap / near.width * (growth > 1e-6 ? std::log1p(growth) / growth : 1);
  return NarrowPlace{
      {a.x + near.along * u.x, a.y + near.along * u.y}, near.width, overlap, kTrianglesPerWidth * widths};
}

}  // namespace

std::optional<NarrowPlace> find_narrow_place(const Triangulation& mesh) {
  IdVector<VertexId, std::vector<VertexId>> joined(mesh.points.size());  // by a segment
  for (const RootSegment& root : mesh.roots)
    for (const int end : {0, 1}) joined[root.vertex[end]].push_back(root.vertex[1 - end]);
  std::optional<NarrowPlace> worst;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int k = 0; k < 3; ++k) {
      const HalfEdge h = half_edge(t, k);
      if (!is_constrained(mesh.twin(h))) continue;
      const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h), c = mesh.apex(h);
      for (const VertexId d : joined[c]) {
        if (d == a || d == b) continue;
        const auto place = place_between(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
        if (place && (!worst || place->triangles > worst->triangles)) worst = place;
      }
    }
  }
  return worst;
}

}  // namespace driftmesh
