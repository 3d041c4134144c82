#include "mesh/domain_outline.hpp"

#include "mesh/cdt.hpp"

namespace driftmesh {

OutlineSegments domain_outline(const Pslg& pslg) {
  const Triangulation mesh = triangulate(pslg);
  OutlineSegments outline;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int i = 0; i < 3; ++i)
      if (mesh.across(half_edge(t, i)) == kNone)
        outline.push_back({mesh.corner(t, (i + 1) % 3), mesh.corner(t, (i + 2) % 3)});
  }
  return outline;
}

}  // namespace driftmesh
