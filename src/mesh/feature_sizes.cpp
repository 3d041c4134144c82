#include "mesh/feature_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"
#include "mesh/corners.hpp"

namespace driftmesh {

bool is_shell_edge(const Triangulation& mesh, VertexId u, VertexId v) {
  return !is_input(mesh.origin[u]) && on_same_shell(mesh, u, v);
}

double distance_to_segment(const Triangulation& mesh, TriangleId t, int i, double length, double twice_area) {
  const HalfEdge h = half_edge(t, i);
  if (!is_constrained(mesh.twin(h))) return kNoBound;
  const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h), c = mesh.apex(h);
  const Point &pa = mesh.points[a], &pb = mesh.points[b], &pc = mesh.points[c];
  const double along = (pc.x - pa.x) * (pb.x - pa.x) + (pc.y - pa.y) * (pb.y - pa.y);
  if (!(along > 0 && along < length * length)) return kNoBound;
  if (is_shell_edge(mesh, a, c) || is_shell_edge(mesh, b, c)) return kNoBound;
  const double distance = twice_area / length;
  return distance > kResolution * length ? distance : kNoBound;
}

GrowingArray<double, VertexId> feature_sizes(const Triangulation& mesh) {
  GrowingArray<double, VertexId> size;  // squared at first
  size.resize(mesh.points.size(), kNoBound);
  const auto lower = [&](VertexId v, double squared) {
    if (squared < size[v]) size[v] = squared;
  };
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i), twin = mesh.twin(h);
      if (!is_constrained(twin) && twin < h) continue;
      const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h);
      if (!is_constrained(twin) && is_shell_edge(mesh, a, b)) continue;
      const double squared = squared_distance(mesh.points[a], mesh.points[b]);
      lower(a, squared);
      lower(b, squared);
      if (!is_constrained(twin)) continue;
      const double twice = 2 * signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      const double part = kPartOfHeight * distance_to_segment(mesh, t, i, std::sqrt(squared), twice);
      lower(mesh.apex(h), part * part);
    }
  }
  for (double& s : size) s = std::sqrt(s);
  return size;
}

}  // namespace driftmesh
