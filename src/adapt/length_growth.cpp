#include "adapt/length_growth.hpp"

#include <cmath>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

/// Calls visit(w) for the vertices w that share an edge with the corner at which `t` has vertex v.
template <class Visit>
void visit_neighbors(const Triangulation& mesh, TriangleId t, VertexId v, const Visit& visit) {
  const auto corner_of = [&](TriangleId u) {
    const auto& corners = mesh.triangles[u].vertex;
    return corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
  };
  const auto turn = [&](bool forward) {  // false if the boundary stops it
    for (TriangleId u = t;;) {
      const int i = corner_of(u);
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
  const auto limit_at = [&](VertexId from, VertexId to) {
    return lengths[from] + gradation * std::sqrt(squared_distance(mesh.points[from], mesh.points[to]));
  };
  // Dijkstra's algorithm from all vertices next to one that is too long: the shortest length is final.
  using Entry = std::pair<double, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const auto& v = mesh.triangles[t].vertex;
    for (int i = 0; i < 3; ++i) {
      const VertexId a = v[i], b = v[next(i)];
      const VertexId shorter = lengths[a] < lengths[b] ? a : b, longer = shorter == a ? b : a;
      if (limit_at(shorter, longer) < lengths[longer]) queue.emplace(lengths[shorter], shorter);
    }
  }
  if (queue.empty()) return false;
  IdVector<VertexId, TriangleId> triangle_at(mesh.points.size(), kNone);
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive())
      for (const VertexId v : mesh.triangles[t].vertex) triangle_at[v] = t;
  while (!queue.empty()) {
    const auto [length, v] = queue.top();
    queue.pop();
    if (length > lengths[v]) continue;
    visit_neighbors(mesh, triangle_at[v], v, [&, from = v](VertexId to) {
      const double limit = limit_at(from, to);
      if (!(limit < lengths[to])) return;
      lengths[to] = limit;
      queue.emplace(limit, to);
    });
  }
  return true;
}

}  // namespace driftmesh::adapt
