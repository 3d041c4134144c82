#include "decompose/subdomain_mesh.hpp"

#include <algorithm>
#include <string>

#include "driftmesh/error.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/cdt.hpp"

namespace driftmesh {
namespace {

constexpr auto id = &Triangulation::id;

/// The points of a subdomain in ascending order, so that roots keep their direction.
std::vector<GlobalPointId> points_of(const Decomposition& d, SubdomainId i) {
  const auto inner = d.inner_points_of(i);
  std::vector<GlobalPointId> points(inner.begin(), inner.end());
  for (const RootId r : d.roots_of(i)) {
    points.push_back(d.roots[id(r)].a);
    points.push_back(d.roots[id(r)].b);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

SubdomainMesh subdomain_triangulation(const Decomposition& d, SubdomainId i) {
  const std::vector<GlobalPointId> points = points_of(d, i);
  const auto local = [&](GlobalPointId v) {
    return static_cast<std::int32_t>(std::lower_bound(points.begin(), points.end(), v) - points.begin());
  };
  SubdomainMesh result;
  result.roots.assign(d.roots_of(i).begin(), d.roots_of(i).end());
  Pslg pslg;
  for (const GlobalPointId v : points) pslg.points.push_back(d.points[id(v)]);
  std::vector<SegmentSides> sides;
  for (const RootId r : result.roots) {
    const Decomposition::Root& root = d.roots[id(r)];
    pslg.segments.push_back({local(root.a), local(root.b), root.marker});
    sides.push_back({root.left == i ? std::int32_t{root.left_region} : kNone,
                     root.right == i ? std::int32_t{root.right_region} : kNone});
  }
  result.mesh = triangulate(pslg, sides);
  if (result.mesh.roots.size() != result.roots.size())
    throw Error("subdomain " + std::to_string(i) + " of the decomposition is broken: roots lie twice on one line");
  for (std::size_t r = 0; r < result.roots.size(); ++r) result.mesh.roots[r].shell = d.roots[id(result.roots[r])].shell;
  for (VertexOrigin& origin : result.mesh.origin) {
    const GlobalPointId v = points[id(origin)];
    result.points.push_back(v);
    origin = is_shell_end(d.origin[id(v)]) ? d.origin[id(v)] : v;
  }
  return result;
}

}  // namespace driftmesh
