#include "mesh/renumber.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "geometry/box.hpp"
#include "geometry/hilbert_sort.hpp"

namespace driftmesh {
namespace {

std::vector<TriangleId> live_triangles(const Triangulation& mesh) {
  std::vector<TriangleId> live;
  live.reserve(mesh.live_triangles());
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) live.push_back(t);
  return live;
}

HilbertOrder hilbert_order(const Triangulation& mesh) {
  const Box box = Box::of(mesh.points);
  return HilbertOrder(box.low, box.high);
}

void sort_by_hilbert(const Triangulation& mesh, std::vector<TriangleId>& triangles) {
  const HilbertOrder order = hilbert_order(mesh);
  AlongCurve<TriangleId> places;
  places.reserve(triangles.size());
  for (const TriangleId t : triangles) {
    const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
    places.emplace_back(order.index({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}), t);
  }
  sort_along_curve(places);
  std::transform(places.begin(), places.end(), triangles.begin(), [](const auto& place) { return place.second; });
}

IdVector<VertexId, bool> used_vertices(const Triangulation& mesh, const std::vector<TriangleId>& triangles) {
  IdVector<VertexId, bool> used(mesh.points.size(), false);
  for (const TriangleId t : triangles)
    for (const VertexId v : mesh.triangles[t].vertex) used[v] = true;
  return used;
}

/// New ids in the order of first use by `order`, after the given vertices if these come first; kNone for unused
/// vertices.
IdVector<VertexId, VertexId> vertices_by_use(const Triangulation& mesh, const std::vector<TriangleId>& order,
                                             GivenVertices given, IdVector<VertexId, VertexId>& old_of_new) {
  IdVector<VertexId, VertexId> new_of_old(mesh.points.size(), kNone);
  if (given == GivenVertices::kFirst) {
    const IdVector<VertexId, bool> used = used_vertices(mesh, order);
    for (const VertexId v : ids_of(mesh.points))
      if (used[v] && (is_input(mesh.origin[v]) || is_shell_end(mesh.origin[v]))) {
        new_of_old[v] = old_of_new.next_id();
        old_of_new.push_back(v);
      }
  }
  for (const TriangleId t : order)
    for (const VertexId v : mesh.triangles[t].vertex)
      if (new_of_old[v] == kNone) {
        new_of_old[v] = old_of_new.next_id();
        old_of_new.push_back(v);
      }
  return new_of_old;
}

void move_vertices(Triangulation& mesh, const IdVector<VertexId, VertexId>& old_of_new) {
  GrowingArray<Point, VertexId> points;
  GrowingArray<VertexOrigin, VertexId> origin;
  points.reserve(old_of_new.size());
  origin.reserve(old_of_new.size());
  for (const VertexId v : old_of_new) {
    points.push_back(mesh.points[v]);
    origin.push_back(mesh.origin[v]);
  }
  mesh.points.swap(points);
  mesh.origin.swap(origin);
  mesh.free_vertices.clear();
}

void move_triangles(Triangulation& mesh, const std::vector<TriangleId>& order,
                    const IdVector<VertexId, VertexId>& new_vertex) {
  IdVector<TriangleId, TriangleId> new_of_old(mesh.triangles.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) new_of_old[order[i]] = static_cast<TriangleId>(i);
  const auto moved = [&](HalfEdge h) {
    return is_constrained(h) ? h : half_edge(new_of_old[triangle_of(h)], index_of(h));
  };

  GrowingArray<Triangle, TriangleId> triangles;
  GrowingArray<std::uint16_t, TriangleId> region;
  triangles.reserve(order.size());
  for (const TriangleId t : order) {
    Triangle triangle = mesh.triangles[t];
    for (VertexId& v : triangle.vertex) v = new_vertex[v];
    for (HalfEdge& h : triangle.neighbor) h = moved(h);
    triangles.push_back(triangle);
    if (!mesh.region.empty()) region.push_back(mesh.region[t]);
  }
  mesh.triangles.swap(triangles);
  mesh.region.swap(region);
  mesh.free_triangles.clear();
  for (Subsegment& s : mesh.subsegments)
    if (s.is_leaf())
      for (HalfEdge& h : s.half) h = moved(h);
}

void rebuild_in_order(Triangulation& mesh, const std::vector<TriangleId>& order, GivenVertices given) {
  IdVector<VertexId, VertexId> old_of_new;
  const IdVector<VertexId, VertexId> new_vertex = vertices_by_use(mesh, order, given, old_of_new);
  move_triangles(mesh, order, new_vertex);
  for (Subsegment& s : mesh.subsegments)
    for (VertexId& v : s.vertex) v = new_vertex[v];
  for (RootSegment& r : mesh.roots)
    for (VertexId& v : r.vertex) v = new_vertex[v];
  move_vertices(mesh, old_of_new);
}

}  // namespace

void renumber(Triangulation& mesh, GivenVertices given) {
  std::vector<TriangleId> order = live_triangles(mesh);
  sort_by_hilbert(mesh, order);
  rebuild_in_order(mesh, order, given);
}

void compact(Triangulation& mesh) {
  rebuild_in_order(mesh, live_triangles(mesh), GivenVertices::kSorted);
}

void drop_unused_subsegments(Triangulation& mesh) {
  IdVector<SubsegmentId, bool> used(mesh.subsegments.size(), false);
  for (const RootSegment& root : mesh.roots) used[root.tree] = true;
  for (const SubsegmentId s : ids_of(mesh.subsegments)) {  // children follow their parents
    const Subsegment& node = mesh.subsegments[s];
    if (used[s] && !node.is_leaf()) used[node.child] = used[node.second_child()] = true;
  }
  IdVector<SubsegmentId, SubsegmentId> moved(mesh.subsegments.size(), kNone);
  SubsegmentId next_slot{0};
  for (const SubsegmentId s : ids_of(used)) {
    if (!used[s]) continue;
    mesh.subsegments[next_slot] = mesh.subsegments[s];
    moved[s] = next_slot;
    next_slot = after(next_slot);
  }
  mesh.subsegments.resize(to_index(next_slot));
  for (RootSegment& root : mesh.roots) root.tree = moved[root.tree];
  for (const SubsegmentId s : ids_of(mesh.subsegments)) {
    Subsegment& node = mesh.subsegments[s];
    if (!node.is_leaf()) {
      node.child = moved[node.child];
      mesh.origin[mesh.subsegments[node.child].vertex[1]] = midpoint_of(s);
      continue;
    }
    for (const HalfEdge h : node.half)
      if (h != kNone) mesh.triangles[triangle_of(h)].neighbor[index_of(h)] = constrained(s);
  }
}

}  // namespace driftmesh
