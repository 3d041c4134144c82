#include "mesh/triangulation.hpp"

#include <utility>

#include "base/assert.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

VertexId Triangulation::add_vertex(const Point& p, VertexOrigin what) {
  if (!free_vertices.empty()) {
    const VertexId v = free_vertices.back();
    free_vertices.pop_back();
    points[v] = p;
    origin[v] = what;
    return v;
  }
  const VertexId v = points.next_id();
  points.push_back(p);
  origin.push_back(what);
  return v;
}

void Triangulation::remove_vertex(VertexId v) {
  origin[v] = kDeleted;
  free_vertices.push_back(v);
}

TriangleId Triangulation::add_triangle() {
  if (!free_triangles.empty()) {
    const TriangleId t = free_triangles.back();
    free_triangles.pop_back();
    return t;
  }
  if (static_cast<std::int64_t>(triangles.size()) >= kMaxTriangles)
    throw LimitError("a subdomain cannot hold more than " + std::to_string(kMaxTriangles) +
                     " triangles; use more subdomains or a larger area bound");
  const TriangleId t = triangles.next_id();
  triangles.resize_uninitialized(triangles.size() + 1);
  if (!region.empty()) region.resize_uninitialized(triangles.size());
  return t;
}

void Triangulation::remove_triangle(TriangleId t) {
  triangles[t].vertex[0] = kNone;
  free_triangles.push_back(t);
}

void Triangulation::link(HalfEdge inner, HalfEdge outer) {
  triangles[triangle_of(inner)].neighbor[index_of(inner)] = outer;
  if (is_constrained(outer)) {
    Subsegment& s = subsegments[subsegment_of(outer)];
    const int side = s.vertex[0] == edge_start(inner) ? 0 : 1;
    DM_ASSERT(s.vertex[side] == edge_start(inner) && s.vertex[1 - side] == edge_end(inner));
    s.half[side] = inner;
  } else {
    triangles[triangle_of(outer)].neighbor[index_of(outer)] = inner;
  }
}

RootId Triangulation::add_root(VertexId a, VertexId b, std::int32_t marker, std::int32_t shell) {
  const auto root = narrow<RootId>(roots.size(), "number of segments");
  const auto tree = narrow<SubsegmentId>(subsegments.size(), "number of subsegments");
  const std::array<VertexId, 2> ends{a, b};
  subsegments.push_back({ends, {kNone, kNone}, dyadic::kWhole, root, kNone});
  roots.push_back({ends, marker, shell, tree});
  return root;
}

void Triangulation::turn_around(RootId r) {
  Subsegment& s = subsegments[roots[r].tree];
  std::swap(s.vertex[0], s.vertex[1]);
  std::swap(s.half[0], s.half[1]);
  roots[r].vertex = s.vertex;
}

SubsegmentId Triangulation::halve(SubsegmentId s, VertexId m) {
  const auto child = narrow<SubsegmentId>(subsegments.size(), "number of subsegments");
  const Subsegment whole = subsegments[s];
  const std::array<HalfEdge, 2> unknown{kNone, kNone};
  subsegments.push_back({{whole.vertex[0], m}, unknown, dyadic::first_half(whole.path), whole.root, kNone});
  subsegments.push_back({{m, whole.vertex[1]}, unknown, dyadic::second_half(whole.path), whole.root, kNone});
  subsegments[s].child = child;
  return child;
}

SubsegmentId Triangulation::descend(RootId root, dyadic::Path path) const {
  SubsegmentId s = roots[root].tree;
  while (!subsegments[s].is_leaf() && subsegments[s].path != path) {
    const Subsegment& node = subsegments[s];
    s = dyadic::descends_second(node.path, path) ? node.second_child() : node.child;
  }
  return s;
}

}  // namespace driftmesh
