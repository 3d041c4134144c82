#include "decompose/subdomain_mesh.hpp"

#include <algorithm>
#include <string>

#include "driftmesh/error.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/cdt.hpp"

namespace driftmesh {

IdVector<VertexId, GlobalPointId> points_of(const Decomposition& d, SubdomainId i) {
  const auto inner = d.inner_points_of(i);
  IdVector<VertexId, GlobalPointId> points(inner.begin(), inner.end());
  for (const GlobalRootId r : d.roots_of(i)) {
    points.push_back(d.roots[r].a);
    points.push_back(d.roots[r].b);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

VertexOrigin origin_of(const Decomposition& d, GlobalPointId v) {
  return is_shell_end(d.origin[v]) ? d.origin[v] : to_int(v);
}

SubdomainMesh subdomain_triangulation(const Decomposition& d, SubdomainId i) {
  const IdVector<VertexId, GlobalPointId> points = points_of(d, i);  // ascending: roots keep their direction
  const auto local = [&](GlobalPointId v) {
    return static_cast<std::int32_t>(std::lower_bound(points.begin(), points.end(), v) - points.begin());
  };
  SubdomainMesh result;
  result.roots.assign(d.roots_of(i).begin(), d.roots_of(i).end());
  Pslg pslg;
  for (const GlobalPointId v : points) pslg.points.push_back(d.points[v]);
  std::vector<SegmentSides> sides;
  for (const GlobalRootId r : result.roots) {
    const Decomposition::Root& root = d.roots[r];
    const std::int32_t left = root.left == i ? std::int32_t{root.left_region} : kNone;
    const std::int32_t right = root.right == i ? std::int32_t{root.right_region} : kNone;
    pslg.segments.push_back({local(std::min(root.a, root.b)), local(std::max(root.a, root.b)), root.marker});
    sides.push_back(root.a < root.b ? SegmentSides{left, right} : SegmentSides{right, left});
  }
  result.mesh = triangulate(pslg, sides);
  if (result.mesh.roots.size() != result.roots.size())
    throw Error("subdomain " + to_string(i) + " of the decomposition is broken: two roots coincide");
  for (const RootId r : ids_of(result.roots)) {
    const Decomposition::Root& root = d.roots[result.roots[r]];
    result.mesh.roots[r].shell = root.shell;
    if (root.a > root.b) result.mesh.turn_around(r);
  }
  for (VertexOrigin& origin : result.mesh.origin) {
    const GlobalPointId v = points[VertexId{origin}];  // the points of the PSLG
    result.points.push_back(v);
    origin = origin_of(d, v);
  }
  return result;
}

}  // namespace driftmesh
