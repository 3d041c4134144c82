#include "adapt/length_growth.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "sizing/lower_lengths.hpp"

namespace driftmesh::adapt {
namespace {

/// Calls visit(w) for the vertices w that share an edge with the corner at which `t` has vertex v.
template <class Visit>
void visit_neighbors(const Triangulation& mesh, TriangleId t, VertexId v, const Visit& visit) {
  const auto turn = [&](bool forward) {  // false if the boundary stops it
    for (TriangleId u = t;;) {
      const int i = mesh.corner_of(u, v);
      visit(mesh.triangles[u].vertex[forward ? previous(i) : next(i)]);
      const HalfEdge beyond = mesh.across(half_edge(u, forward ? next(i) : previous(i)));
      if (beyond == kNone) return false;
      u = triangle_of(beyond);
      if (u == t) return true;
    }
  };
  if (!turn(true)) turn(false);
}

}  // namespace

bool limit_growth(const Triangulation& mesh, double gradation, Lengths& lengths) {
  const auto limit = [&](VertexId from, VertexId to) {
    return lengths[from] + gradation * std::sqrt(squared_distance(mesh.points[from], mesh.points[to]));
  };
  std::vector<std::pair<double, VertexId>> lowering;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const auto& v = mesh.triangles[t].vertex;
    for (int i = 0; i < 3; ++i) {
      const VertexId a = v[i], b = v[next(i)];
      const VertexId shorter = lengths[a] < lengths[b] ? a : b, longer = shorter == a ? b : a;
      if (limit(shorter, longer) < lengths[longer]) lowering.emplace_back(lengths[shorter], shorter);
    }
  }
  if (lowering.empty()) return false;
  IdVector<VertexId, TriangleId> triangle_at(mesh.points.size(), kNone);
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive())
      for (const VertexId v : mesh.triangles[t].vertex) triangle_at[v] = t;
  const auto visit = [&](VertexId v, const auto& take) { visit_neighbors(mesh, triangle_at[v], v, take); };
  lower_lengths(std::move(lowering), lengths, visit, limit);
  return true;
}

}  // namespace driftmesh::adapt
