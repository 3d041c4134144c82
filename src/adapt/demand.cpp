#include "adapt/demand.hpp"

#include <algorithm>

#include "adapt/mend.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/bound_forecast.hpp"

namespace driftmesh::adapt {

Demand demand_of(const Triangulation& mesh, const QualityBounds& bounds, const Lengths& lengths,
                 const SizeField* between, const Lengths* made_for) {
  QualityBounds all = bounds;
  all.size = between;
  const AreaBounds areas(mesh, all);
  Demand demand;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const CornerPoints corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const double twice = 2 * signed_area(corners[0], corners[1], corners[2]);
    double asked = 1 / areas.constant(t);  // per twice the area
    bool too_large = twice > areas.constant(t), has_grown = false;
    if (!lengths.empty()) {
      const auto& v = mesh.triangles[t].vertex;
      const double a = lengths[v[0]], b = lengths[v[1]], c = lengths[v[2]], least = std::min({a, b, c});
      const auto at = [](double h) { return 1 / twice_area_of_edge(h); };
      const auto at_corners = [&] { return least; };
      asked = std::max(asked, (at((a + b) / 2) + at((b + c) / 2) + at((c + a) / 2)) / 3);
      too_large = too_large || twice > twice_area_of_edge(least) ||
                  (between != nullptr && areas.above_size(corners, twice, at_corners, true));
      has_grown = made_for != nullptr &&
                  std::ranges::any_of(v, [&](VertexId w) { return lengths[w] > kGrown * (*made_for)[w]; });
    }
    const double triangles = kTrianglesPerBound * asked * twice;
    demand.triangles += triangles;
    demand.too_large = demand.too_large || too_large;
    if (too_large) demand.changes += std::max(1.0, triangles);
    if (!too_large && has_grown) demand.changes += std::max(0.0, 1 - triangles);
  }
  return demand;
}

}  // namespace driftmesh::adapt
