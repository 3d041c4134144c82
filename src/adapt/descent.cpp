#include "adapt/descent.hpp"

#include <algorithm>

#include "adapt/locator.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

/// The triangle with these corners. Looks around the first one, whose triangle t is.
TriangleId find(const Triangulation& mesh, const Locator& locator, TriangleId t,
                const std::array<VertexId, 3>& corners) {
  const auto has_corners = [&](TriangleId u) {
    return std::ranges::all_of(mesh.triangles[u].vertex,
                               [&](VertexId w) { return std::ranges::count(corners, w) == 1; });
  };
  for (const bool forward : {true, false})
    for (TriangleId u = t;;) {
      if (has_corners(u)) return u;
      const int i = mesh.corner_of(u, corners[0]);
      const HalfEdge beyond = mesh.across(half_edge(u, forward ? next(i) : previous(i)));
      if (beyond == kNone) break;
      u = triangle_of(beyond);
      if (u == t) return kNone;
    }
  // The triangles around a vertex of the boundary may be apart from each other.
  const TriangleId u =
      locator.locate(centroid({mesh.points[corners[0]], mesh.points[corners[1]], mesh.points[corners[2]]})).triangle;
  return has_corners(u) ? u : kNone;
}

/// A mesh that was mended keeps most of its vertices where they are in memory.
bool stays_in_place(const Triangulation& old_mesh, const Triangulation& new_mesh, VertexId v) {
  return old_mesh.points.has(v) && old_mesh.origin[v] != kDeleted && old_mesh.points[v] == new_mesh.points[v];
}

}  // namespace

Descent trace(const Triangulation& old_mesh, const Triangulation& new_mesh) {
  Descent descent;
  descent.sources.resize(new_mesh.points.size());
  IdVector<VertexId, TriangleId> around(new_mesh.points.size(), kNone);
  const Locator locator(old_mesh);
  for (const VertexId v : ids_of(new_mesh.points)) {
    if (new_mesh.origin[v] == kDeleted) continue;
    if (stays_in_place(old_mesh, new_mesh, v)) {
      descent.sources[v] = {{v, v, v}, {1, 0, 0}, true};
      continue;
    }
    const Locator::Place place = locator.locate(new_mesh.points[v]);
    const auto& corners = old_mesh.triangles[place.triangle].vertex;
    if (place.is_vertex()) {
      const VertexId same = corners[place.corner];
      descent.sources[v] = {{same, same, same}, {1, 0, 0}, true};
    } else {
      descent.sources[v] = {corners, place.weight, false};
    }
    around[v] = place.triangle;
  }
  descent.same.assign(new_mesh.triangles.size(), kNone);
  for (const TriangleId t : ids_of(new_mesh.triangles)) {
    if (!new_mesh.triangles[t].alive()) continue;
    const auto& v = new_mesh.triangles[t].vertex;
    if (!std::ranges::all_of(v, [&](VertexId w) { return descent.sources[w].stays; })) continue;
    if (old_mesh.triangles.has(t) && old_mesh.triangles[t].vertex == v &&
        std::ranges::all_of(v, [&](VertexId w) { return descent.sources[w].vertex[0] == w; })) {
      descent.same[t] = t;
      continue;
    }
    if (around[v[0]] == kNone) around[v[0]] = locator.locate(new_mesh.points[v[0]]).triangle;
    std::array<VertexId, 3> old{};
    for (int i = 0; i < 3; ++i) old[i] = descent.sources[v[i]].vertex[0];
    descent.same[t] = find(old_mesh, locator, around[v[0]], old);
  }
  return descent;
}

}  // namespace driftmesh::adapt
