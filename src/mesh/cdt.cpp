#include "mesh/cdt.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "base/assert.hpp"
#include "base/formatted.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "geometry/box.hpp"
#include "geometry/hilbert_sort.hpp"
#include "geometry/predicates.hpp"
#include "mesh/carve.hpp"
#include "mesh/cavity.hpp"
#include "mesh/flips.hpp"
#include "mesh/renumber.hpp"
#include "pslg/convex_hull.hpp"

namespace driftmesh {
namespace {

/// Least margin around a domain without extent, as the predicates need it.
constexpr double kSmallestMargin = 0x1p-120;

/// Adds a box around all points. Constrained segments will hide its corners from the inside of the domain, so the final
/// triangulation is Delaunay however far away they are.
void add_box(Triangulation& mesh, const Pslg& pslg) {
  const auto [low, high] = Box::of(pslg.points);
  const double margin = 4 * std::max({high.x - low.x, high.y - low.y, std::ldexp(std::abs(low.x), -40),
                                      std::ldexp(std::abs(low.y), -40), kSmallestMargin});
  const VertexId a = mesh.add_vertex({low.x - margin, low.y - margin}, kFrame);
  const VertexId b = mesh.add_vertex({high.x + margin, low.y - margin}, kFrame);
  const VertexId c = mesh.add_vertex({high.x + margin, high.y + margin}, kFrame);
  const VertexId d = mesh.add_vertex({low.x - margin, high.y + margin}, kFrame);
  const RootId ab = mesh.add_root(a, b, 0, kNone), bc = mesh.add_root(b, c, 0, kNone);
  const RootId cd = mesh.add_root(c, d, 0, kNone), da = mesh.add_root(d, a, 0, kNone);
  const TriangleId t = mesh.add_triangle(), u = mesh.add_triangle();
  mesh.triangles[t].vertex = {a, b, c};
  mesh.triangles[u].vertex = {a, c, d};
  const auto frame = [&](RootId root) { return constrained(mesh.roots[root].tree); };
  mesh.link(half_edge(t, 2), frame(ab));
  mesh.link(half_edge(t, 0), frame(bc));
  mesh.link(half_edge(u, 0), frame(cd));
  mesh.link(half_edge(u, 1), frame(da));
  mesh.link(half_edge(t, 1), half_edge(u, 2));
}

std::string describe(const Triangulation& mesh, VertexId v) {
  const Point& p = mesh.points[v];
  return formatted("point {} ({}, {})", mesh.origin[v], p.x, p.y);
}

/// Adds the points in the order in which they are to be inserted, so that neighbors in the plane are neighbors in
/// memory. Returns the vertex of each.
std::vector<VertexId> add_points(Triangulation& mesh, const std::vector<Point>& points) {
  std::vector<VertexId> vertex(points.size());
  for (const std::size_t i : in_hilbert_order(points))
    vertex[i] = mesh.add_vertex(points[i], narrow<VertexOrigin>(i, "number of points"));
  return vertex;
}

void insert_points(Triangulation& mesh, std::size_t count) {
  Cavity cavity(mesh);
  TriangleId near{0};
  for (const VertexId v : IdRange<VertexId>(count)) {
    const Cavity::Found found = cavity.gather_from_afar(mesh.points[v], near);
    if (found != Cavity::Found::kClear)
      throw Error(describe(mesh, v) + " coincides with another point; repair the input first");
    cavity.fill(v);
    near = cavity.fresh_triangle(0);
  }
}

/// Forces the segments of a PSLG into the triangulation of its points, by flips (Sloan 1993), and restores the
/// constrained Delaunay property by more flips.
class SegmentRecovery {
 public:
  explicit SegmentRecovery(Triangulation& mesh) : mesh_(mesh), incident_(mesh.points.size(), kNone) {
    for (const TriangleId t : ids_of(mesh.triangles)) note(t);
  }

  void recover(VertexId a, VertexId b, std::int32_t marker) {
    const HalfEdge h = find_edge_or_crossing(a, b);
    HalfEdge edge = h;
    if (mesh_.edge_start(h) != a) {  // an edge in the way
      collect_crossings(a, b, h);
      flip_crossings(a, b);
      edge = find_edge_or_crossing(a, b);
    }
    const auto [low, high] = mesh_.origin[a] < mesh_.origin[b] ? std::pair(a, b) : std::pair(b, a);
    constrain(edge, mesh_.add_root(low, high, marker, kNone));
    restore_delaunay();
  }

 private:
  using Pair = std::pair<VertexId, VertexId>;

  void note(TriangleId t) {
    for (const VertexId v : mesh_.triangles[t].vertex) incident_[v] = t;
  }

  const Point& at(VertexId v) const { return mesh_.points[v]; }

  [[noreturn]] void not_repaired(VertexId a, VertexId b, const std::string& what) const {
    throw Error("the segment from " + describe(mesh_, a) + " to " + describe(mesh_, b) + " " + what +
                "; repair the input first");
  }

  /// Turns around `a` to the half-edge from a to b if there is one, or else to the edge opposite to a that ab crosses.
  HalfEdge find_edge_or_crossing(VertexId a, VertexId b) const {
    const TriangleId first = incident_[a];
    TriangleId t = first;
    do {
      const auto& v = mesh_.triangles[t].vertex;
      const int i = mesh_.corner_of(t, a);
      const VertexId s = v[next(i)], e = v[previous(i)];
      if (s == b) return half_edge(t, previous(i));
      const double right = orient2d(at(a), at(s), at(b));
      const bool ahead = (at(s).x - at(a).x) * (at(b).x - at(a).x) + (at(s).y - at(a).y) * (at(b).y - at(a).y) > 0;
      if (right == 0 && ahead) not_repaired(a, b, "passes through " + describe(mesh_, s));
      if (e != b && right > 0 && orient2d(at(a), at(b), at(e)) > 0) return half_edge(t, i);
      t = triangle_of(mesh_.across(half_edge(t, next(i))));
    } while (t != first);
    not_repaired(a, b, "leaves the triangulation");
  }

  void collect_crossings(VertexId a, VertexId b, HalfEdge h) {
    for (;;) {
      const HalfEdge g = mesh_.twin(h);
      if (is_constrained(g)) not_repaired(a, b, "crosses another one");
      crossings_.emplace_back(mesh_.edge_start(h), mesh_.edge_end(h));
      const VertexId d = mesh_.apex(g);
      if (d == b) return;
      const double side = orient2d(at(a), at(b), at(d));
      if (side == 0) not_repaired(a, b, "passes through " + describe(mesh_, d));
      // g runs from the left end to the right end of the crossed edge; the next crossed edge joins d to the other side.
      h = half_edge(triangle_of(g), side > 0 ? next(index_of(g)) : previous(index_of(g)));
    }
  }

  /// The triangle after `t` counterclockwise around u. The fan around a corner of the box is open: from its last
  /// triangle to its first.
  TriangleId turn(TriangleId t, VertexId u) const {
    HalfEdge h = mesh_.across(half_edge(t, next(mesh_.corner_of(t, u))));
    if (h != kNone) return triangle_of(h);
    while ((h = mesh_.across(half_edge(t, previous(mesh_.corner_of(t, u))))) != kNone) t = triangle_of(h);
    return t;
  }

  HalfEdge find_edge(VertexId u, VertexId w) const {
    const TriangleId first = incident_[u];
    TriangleId t = first;
    do {
      const int i = mesh_.corner_of(t, u);
      if (mesh_.triangles[t].vertex[next(i)] == w) return half_edge(t, previous(i));
      t = turn(t, u);
    } while (t != first);
    return kNone;
  }

  void flip_crossings(VertexId a, VertexId b) {
    while (!crossings_.empty()) {
      const auto [u, w] = crossings_.front();
      crossings_.pop_front();
      const HalfEdge h = find_edge(u, w);
      if (!is_flippable(mesh_, h)) {
        crossings_.emplace_back(u, w);
        continue;
      }
      const HalfEdge g = flip(mesh_, h);
      note_flip(g);
      const VertexId c = mesh_.edge_start(g), d = mesh_.edge_end(g);
      const bool touches = c == a || c == b || d == a || d == b;
      if (!touches && (orient2d(at(a), at(b), at(c)) > 0) != (orient2d(at(a), at(b), at(d)) > 0))
        crossings_.emplace_back(c, d);
    }
  }

  void note_flip(HalfEdge g) {
    for (const TriangleId t : {triangle_of(g), triangle_of(mesh_.twin(g))}) {
      note(t);
      flipped_.push_back(t);
    }
  }

  void constrain(HalfEdge h, RootId root) {
    const HalfEdge g = mesh_.twin(h);
    if (is_constrained(g)) return;  // a duplicate segment: repair() removes those
    const HalfEdge s = constrained(mesh_.roots[root].tree);
    mesh_.link(h, s);
    mesh_.link(g, s);
  }

  void restore_delaunay() {
    pending_.clear();
    for (const TriangleId t : flipped_)
      for (int i = 0; i < 3; ++i) pending_.push_back(half_edge(t, i));
    flipped_.clear();
    legalize(mesh_, pending_, flipped_);
    for (const TriangleId t : flipped_) note(t);
    flipped_.clear();
  }

  Triangulation& mesh_;
  IdVector<VertexId, TriangleId> incident_;  // a triangle of each vertex
  std::deque<Pair> crossings_;
  std::vector<TriangleId> flipped_;
  std::vector<HalfEdge> pending_;
};

void recover_segments(Triangulation& mesh, const std::vector<Pslg::Segment>& segments,
                      const std::vector<VertexId>& vertex) {
  SegmentRecovery recovery(mesh);
  for (const Pslg::Segment& s : segments) recovery.recover(vertex[s.a], vertex[s.b], s.marker);
}

/// The segments, or those of the convex hull if there are none.
std::vector<Pslg::Segment> segments_or_hull(const Pslg& pslg) {
  if (!pslg.segments.empty()) return pslg.segments;
  std::vector<Pslg::Segment> hull = convex_hull(pslg.points);
  if (hull.empty()) throw Error("all points lie on one line");
  return hull;
}

Triangulation triangulate_box(const Pslg& pslg) {
  if (pslg.points.size() < 3) throw Error("a domain needs at least three points");
  Triangulation mesh;
  const std::vector<VertexId> vertex = add_points(mesh, pslg.points);
  add_box(mesh, pslg);
  insert_points(mesh, vertex.size());
  recover_segments(mesh, segments_or_hull(pslg), vertex);
  return mesh;
}

}  // namespace

Triangulation triangulate(const Pslg& pslg, CarveReport* report) {
  Triangulation mesh = triangulate_box(pslg);
  CarveReport carved = carve(mesh, pslg, mesh.roots.size() - pslg.segments.size());
  if (report != nullptr) *report = std::move(carved);
  renumber(mesh, GivenVertices::kSorted);
  return mesh;
}

Triangulation triangulate(const Pslg& pslg, const std::vector<SegmentSides>& sides) {
  DM_ASSERT(sides.size() == pslg.segments.size());
  DM_ASSERT(std::ranges::all_of(pslg.segments, [](const Pslg::Segment& s) { return s.a < s.b; }));
  Triangulation mesh = triangulate_box(pslg);
  carve(mesh, sides, mesh.roots.size() - sides.size());
  renumber(mesh, GivenVertices::kSorted);
  return mesh;
}

}  // namespace driftmesh
