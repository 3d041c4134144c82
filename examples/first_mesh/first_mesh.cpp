// The unit square, finer toward one corner, as a VTU file for ParaView.
#include <cmath>
#include <cstdio>
#include <driftmesh/driftmesh.hpp>

int main() {
  driftmesh::Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  const auto finer_at_origin = [](const driftmesh::Point& p) { return 0.01 + 0.1 * std::hypot(p.x, p.y); };
  const driftmesh::Mesh mesh = driftmesh::mesh(square, {.min_angle = 30, .size = finer_at_origin});
  driftmesh::write_mesh(mesh, "square.vtu");
  std::printf("%zu triangles\n", mesh.triangles.size());
}
