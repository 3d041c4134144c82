#include "mesh/with_seeds.hpp"

#include <utility>

#include "mesh/areas.hpp"
#include "mesh/cdt.hpp"

namespace driftmesh {

Pslg with_seeds(const Pslg& pslg) {
  CarveReport report;
  const Triangulation mesh = triangulate(pslg, &report);
  Pslg seeded = pslg;
  seeded.polygons.clear();
  seeded.holes = std::move(report.holes);
  seeded.segments.clear();
  for (const RootSegment& root : mesh.roots)
    seeded.segments.push_back({mesh.origin[root.vertex[0]], mesh.origin[root.vertex[1]], root.marker});
  seeded.regions.clear();
  if (mesh.region.empty()) return seeded;
  const Areas areas(mesh);
  for (const AreaId area : areas.ids()) {
    const TriangleId t = areas.largest(area);
    if (mesh.region[t] == 0) continue;
    seeded.regions.push_back(pslg.regions[to_index(mesh.region[t]) - 1]);
    seeded.regions.back().at = center_of(mesh, t);
  }
  return seeded;
}

}  // namespace driftmesh
