#include "mesh/areas.hpp"

#include <vector>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

Areas::Areas(const Triangulation& mesh) : of_(mesh.triangles.size(), kNone) {
  std::vector<TriangleId> stack;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && of_[t] == kNone) flood(mesh, t, stack);
}

void Areas::flood(const Triangulation& mesh, TriangleId first, std::vector<TriangleId>& stack) {
  const AreaId area = largest_.next_id();
  largest_.push_back(first);
  of_[first] = area;
  stack.push_back(first);
  double most = 0;
  while (!stack.empty()) {
    const TriangleId t = stack.back();
    stack.pop_back();
    if (const double size = signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)); size > most) {
      most = size;
      largest_[area] = t;
    }
    for (const HalfEdge h : mesh.triangles[t].neighbor)
      if (!is_constrained(h) && of_[triangle_of(h)] == kNone) {
        of_[triangle_of(h)] = area;
        stack.push_back(triangle_of(h));
      }
  }
}

Point center_of(const Triangulation& mesh, TriangleId t) {
  const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
  return {a.x + ((b.x - a.x) + (c.x - a.x)) / 3, a.y + ((b.y - a.y) + (c.y - a.y)) / 3};
}

}  // namespace driftmesh
