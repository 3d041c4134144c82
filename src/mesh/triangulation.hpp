#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/growing_array.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "dyadic/path.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// 24 bytes: the corners counterclockwise, and opposite to each corner the twin half-edge in the neighbor (or the
/// constrained subsegment). A free slot has vertex[0] == kNone.
struct Triangle {
  std::array<VertexId, 3> vertex;
  std::array<HalfEdge, 3> neighbor;
  [[nodiscard]] bool alive() const { return vertex[0] != kNone; }
};

/// A node of the binary tree of one root segment: an interval that is a leaf (a constrained edge of the mesh) or has
/// been cut at its midpoint.
struct Subsegment {
  std::array<VertexId, 2> vertex;  ///< its ends, in the root's direction
  std::array<HalfEdge, 2> half;    ///< for a leaf, the edge left and right of that direction, kNone outside the domain
  dyadic::Path path;               ///< its interval of the root
  RootId root;
  SubsegmentId child;  ///< kNone for a leaf, else the first half; the second follows it
  [[nodiscard]] bool is_leaf() const { return child == kNone; }
  [[nodiscard]] SubsegmentId second_child() const { return after(child); }
};

/// A segment that is cut only at dyadic points: a segment of the input, or a piece of one after corners were prepared.
struct RootSegment {
  std::array<VertexId, 2>
      vertex;  ///< in its direction: from the lower to the higher global ID, or away from an acute corner
  std::int32_t marker = 0;
  std::int32_t shell = kNone;  ///< for a shell piece (see corners.hpp), which two circles of which corner it joins
  SubsegmentId tree = kNone;   ///< the root of its tree of subsegments
};

/// A constrained Delaunay triangulation: topology in flat arrays, coordinates beside it. Plain data with the few
/// operations that keep its invariants; the algorithms on it live in files of their own (cdt, cavity, flips,
/// refiner). Invariants between operations: every live triangle is counterclockwise; neighbors are reciprocal; each
/// leaf subsegment knows its half-edges and they know it.
struct Triangulation {
  GrowingArray<Triangle, TriangleId> triangles;
  GrowingArray<Point, VertexId> points;
  GrowingArray<VertexOrigin, VertexId> origin;  ///< one for each vertex
  /// Index of the region of each triangle; empty when the domain has one region.
  GrowingArray<std::uint16_t, TriangleId> region;
  IdVector<SubsegmentId, Subsegment> subsegments;
  IdVector<RootId, RootSegment> roots;
  std::vector<TriangleId> free_triangles;
  std::vector<VertexId> free_vertices;

  [[nodiscard]] std::size_t live_triangles() const { return triangles.size() - free_triangles.size(); }
  [[nodiscard]] std::size_t live_vertices() const { return points.size() - free_vertices.size(); }
  [[nodiscard]] const Point& corner(TriangleId t, int i) const { return points[triangles[t].vertex[i]]; }
  /// The corner at which `t` has vertex v.
  [[nodiscard]] int corner_of(TriangleId t, VertexId v) const {
    const auto& vertex = triangles[t].vertex;
    return vertex[0] == v ? 0 : vertex[1] == v ? 1 : 2;
  }
  [[nodiscard]] VertexId apex(HalfEdge h) const { return triangles[triangle_of(h)].vertex[index_of(h)]; }
  [[nodiscard]] VertexId edge_start(HalfEdge h) const { return triangles[triangle_of(h)].vertex[next(index_of(h))]; }
  [[nodiscard]] VertexId edge_end(HalfEdge h) const { return triangles[triangle_of(h)].vertex[previous(index_of(h))]; }
  [[nodiscard]] HalfEdge twin(HalfEdge h) const { return triangles[triangle_of(h)].neighbor[index_of(h)]; }

  /// The half-edge on the other side of `h`, also of a constrained one; kNone where the domain ends.
  [[nodiscard]] HalfEdge across(HalfEdge h) const {
    const HalfEdge g = twin(h);
    if (!is_constrained(g)) return g;
    const auto& half = subsegments[subsegment_of(g)].half;
    return half[0] == h ? half[1] : half[0];
  }

  /// A new vertex at `p`, in a free slot if there is one.
  VertexId add_vertex(const Point& p, VertexOrigin what);
  void remove_vertex(VertexId v);
  /// A slot for a triangle (uninitialized), a free one if there is one. Throws LimitError past kMaxTriangles.
  TriangleId add_triangle();
  /// The same for `count` triangles at once.
  void add_triangles(TriangleId* slots, int count) {
    const std::size_t size = triangles.size() + static_cast<std::size_t>(count);
    if (!free_triangles.empty() || !region.empty() || size > triangles.capacity() || size > kMaxTriangles)
        [[unlikely]] {
      for (int i = 0; i < count; ++i) slots[i] = add_triangle();
      return;
    }
    for (int i = 0; i < count; ++i) slots[i] = TriangleId{to_int(triangles.next_id()) + i};
    triangles.resize_uninitialized(size);
  }
  void remove_triangle(TriangleId t);
  /// Links `inner` (an edge of a live triangle) to what lies across it, a half-edge or a constrained subsegment.
  void link(HalfEdge inner, HalfEdge outer);
  /// A new root segment from `a` to `b` with one leaf; its half-edges are still kNone.
  RootId add_root(VertexId a, VertexId b, std::int32_t marker, std::int32_t shell);
  /// Reverses the direction of a root segment that has not been split.
  void turn_around(RootId r);
  /// Turns leaf `s` into an inner node with two leaves that meet at vertex `m`.
  SubsegmentId halve(SubsegmentId s, VertexId m);
  /// The leaf or inner node of `root` that names interval `path`, or the leaf above it where the tree ends earlier.
  [[nodiscard]] SubsegmentId descend(RootId root, dyadic::Path path) const;
};

}  // namespace driftmesh
