#include "mesh/flips.hpp"

#include "base/assert.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

const Point& point(const Triangulation& mesh, VertexId v) {
  return mesh.points[v];
}

bool is_locally_delaunay(const Triangulation& mesh, HalfEdge h) {
  const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h), c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
  return incircle(point(mesh, a), point(mesh, b), point(mesh, c), point(mesh, d)) <= 0;
}

/// The star of a vertex about to be deleted, as the polygon that remains to be triangulated.
struct Star {
  struct Side {
    VertexId from;   // start of the polygon's edge; the next side begins where this one ends
    HalfEdge outer;  // what lies across
  };
  std::vector<Side> sides;        // counterclockwise
  std::vector<TriangleId> slots;  // triangles of the star
};

Star star_around_apex(const Triangulation& mesh, HalfEdge h) {
  Star star;
  HalfEdge spoke = h;
  do {
    star.sides.push_back({mesh.edge_start(spoke), mesh.twin(spoke)});
    star.slots.push_back(triangle_of(spoke));
    const HalfEdge across = mesh.twin(half_edge(triangle_of(spoke), next(index_of(spoke))));
    DM_ASSERT(!is_constrained(across));  // only free vertices are deleted
    spoke = half_edge(triangle_of(across), next(index_of(across)));
  } while (spoke != h);
  return star;
}

/// The part of the star of a midpoint on one side of its subsegment `whole`, from the half-edge that leaves it along
/// the subsegment. The last side is the subsegment itself.
Star star_beside(const Triangulation& mesh, HalfEdge h, SubsegmentId whole) {
  Star star;
  for (;;) {
    const TriangleId t = triangle_of(h);
    star.sides.push_back({mesh.edge_end(h), mesh.twin(half_edge(t, next(index_of(h))))});
    star.slots.push_back(t);
    const HalfEdge across = mesh.twin(half_edge(t, previous(index_of(h))));
    if (is_constrained(across)) {
      star.sides.push_back({mesh.apex(h), constrained(whole)});
      return star;
    }
    h = across;
  }
}

/// The polygon of a star while corners are cut off it.
using Polygon = std::vector<VertexId>;

/// Whether the corner at position i can be cut off, and how good the triangle is.
enum class Ear { kNone, kTight, kGood };

/// A corner is an ear if it makes a counterclockwise triangle and leaves the deleted vertex inside the rest (tight: on
/// its border), or, of the last four, leaves a counterclockwise triangle.
Ear ear_at(const Triangulation& mesh, const Polygon& polygon, std::size_t i, VertexId center) {
  const std::size_t n = polygon.size();
  const Point& a = point(mesh, polygon[(i + n - 1) % n]);
  const Point& b = point(mesh, polygon[i]);
  const Point& c = point(mesh, polygon[(i + 1) % n]);
  if (!(orient2d(a, b, c) > 0)) return Ear::kNone;
  const double rest = orient2d(a, c, point(mesh, n == 4 ? polygon[(i + 2) % n] : center));
  if (rest > 0) return Ear::kGood;
  return rest == 0 && n > 4 ? Ear::kTight : Ear::kNone;
}

bool holds_no_corner(const Triangulation& mesh, const Polygon& polygon, std::size_t i) {
  const std::size_t n = polygon.size();
  const Point& a = point(mesh, polygon[(i + n - 1) % n]);
  const Point& b = point(mesh, polygon[i]);
  const Point& c = point(mesh, polygon[(i + 1) % n]);
  for (std::size_t j = 2; j + 1 < n; ++j)
    if (incircle(a, b, c, point(mesh, polygon[(i + j) % n])) > 0) return false;
  return true;
}

/// Up to this many corners it pays to look for an ear that is already Delaunay; beyond, flips are cheaper.
constexpr std::size_t kSmallPolygon = 12;

/// The ear whose circumdisk holds no other corner if there is one (it is already Delaunay), else any ear; n if there is
/// none.
std::size_t choose_ear(const Triangulation& mesh, const Polygon& polygon, VertexId center) {
  std::size_t good = polygon.size(), tight = polygon.size();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Ear ear = ear_at(mesh, polygon, i, center);
    if (ear == Ear::kGood && (polygon.size() > kSmallPolygon || holds_no_corner(mesh, polygon, i))) return i;
    if (ear == Ear::kGood) good = i;
    if (ear == Ear::kTight) tight = i;
  }
  return good != polygon.size() ? good : tight;
}

/// Cuts off one corner after another until three are left. False if rounding left a star without an ear.
bool plan_ears(const Triangulation& mesh, const Star& star, VertexId center, std::vector<std::size_t>& ears) {
  Polygon polygon;
  for (const Star::Side& side : star.sides) polygon.push_back(side.from);
  while (polygon.size() > 3) {
    const std::size_t i = choose_ear(mesh, polygon, center);
    if (i == polygon.size()) return false;
    ears.push_back(i);
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return orient2d(point(mesh, polygon[0]), point(mesh, polygon[1]), point(mesh, polygon[2])) > 0;
}

/// Fills a star as planned. Appends edges that may not be Delaunay to `pending`.
void fill_star(Triangulation& mesh, Star& star, const std::vector<std::size_t>& ears, std::vector<HalfEdge>& pending,
               std::vector<TriangleId>& changed) {
  std::vector<Star::Side>& sides = star.sides;
  std::size_t used = 0;
  // Places the triangle over two consecutive sides and returns its third edge.
  const auto place = [&](const Star::Side& ab, const Star::Side& bc, VertexId c) {
    const TriangleId t = star.slots[used++];
    mesh.triangles[t].vertex = {ab.from, bc.from, c};
    mesh.link(half_edge(t, 2), ab.outer);
    mesh.link(half_edge(t, 0), bc.outer);
    changed.push_back(t);
    return half_edge(t, 1);
  };
  for (const std::size_t i : ears) {
    const std::size_t n = sides.size();
    const std::size_t before = (i + n - 1) % n;
    const HalfEdge cut = place(sides[before], sides[i], sides[(i + 1) % n].from);
    pending.push_back(cut);
    sides[before].outer = cut;
    sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(i));
  }
  mesh.link(place(sides[0], sides[1], sides[2].from), sides[2].outer);
  for (; used < star.slots.size(); ++used) mesh.remove_triangle(star.slots[used]);
}

}  // namespace

bool is_flippable(const Triangulation& mesh, HalfEdge h) {
  const Point& a = point(mesh, mesh.edge_start(h));
  const Point& b = point(mesh, mesh.edge_end(h));
  const Point& c = point(mesh, mesh.apex(h));
  const Point& d = point(mesh, mesh.apex(mesh.twin(h)));
  return orient2d(c, a, d) > 0 && orient2d(d, b, c) > 0;
}

HalfEdge flip(Triangulation& mesh, HalfEdge h) {
  const HalfEdge g = mesh.twin(h);
  const TriangleId t = triangle_of(h), u = triangle_of(g);
  const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h), c = mesh.apex(h), d = mesh.apex(g);
  const HalfEdge bc = mesh.twin(half_edge(t, next(index_of(h))));
  const HalfEdge ca = mesh.twin(half_edge(t, previous(index_of(h))));
  const HalfEdge ad = mesh.twin(half_edge(u, next(index_of(g))));
  const HalfEdge db = mesh.twin(half_edge(u, previous(index_of(g))));
  // Before: t = (c, a, b), u = (d, b, a). After: t = (d, b, c), u = (c, a, d), sharing the edge c d.
  mesh.triangles[t].vertex = {b, c, d};
  mesh.triangles[u].vertex = {a, d, c};
  mesh.link(half_edge(t, 0), half_edge(u, 0));
  mesh.link(half_edge(t, 2), bc);
  mesh.link(half_edge(t, 1), db);
  mesh.link(half_edge(u, 2), ad);
  mesh.link(half_edge(u, 1), ca);
  return half_edge(t, 0);
}

void legalize(Triangulation& mesh, std::vector<HalfEdge>& pending, std::vector<TriangleId>& changed) {
  while (!pending.empty()) {
    const HalfEdge h = pending.back();
    pending.pop_back();
    if (is_constrained(mesh.twin(h)) || is_locally_delaunay(mesh, h)) continue;
    const HalfEdge g = flip(mesh, h);
    const TriangleId t = triangle_of(g), u = triangle_of(mesh.twin(g));
    changed.push_back(t);
    changed.push_back(u);
    for (const TriangleId k : {t, u})
      for (const int i : {1, 2}) pending.push_back(half_edge(k, i));
  }
}

bool remove_vertex(Triangulation& mesh, HalfEdge h, std::vector<TriangleId>& changed) {
  const VertexId center = mesh.apex(h);
  Star star = star_around_apex(mesh, h);
  std::vector<std::size_t> ears;
  if (!plan_ears(mesh, star, center, ears)) return false;

  std::vector<HalfEdge> pending;
  fill_star(mesh, star, ears, pending, changed);
  mesh.remove_vertex(center);
  legalize(mesh, pending, changed);
  return true;
}

bool undo_midpoint(Triangulation& mesh, SubsegmentId s, std::vector<TriangleId>& changed) {
  const Subsegment &first = mesh.subsegments[mesh.subsegments[s].child],
                   &second = mesh.subsegments[mesh.subsegments[s].second_child()];
  const VertexId center = first.vertex[1];
  struct Planned {
    Star star;
    std::vector<std::size_t> ears;
  };
  std::vector<Planned> sides;
  for (const HalfEdge leaving : {second.half[0], first.half[1]}) {
    if (leaving == kNone) continue;
    Planned& side = sides.emplace_back();
    side.star = star_beside(mesh, leaving, s);
    if (side.star.sides.size() < 3 || !plan_ears(mesh, side.star, center, side.ears)) return false;
  }
  mesh.subsegments[s].child = kNone;
  mesh.subsegments[s].half = {kNone, kNone};
  std::vector<HalfEdge> pending;
  for (Planned& side : sides) fill_star(mesh, side.star, side.ears, pending, changed);
  mesh.remove_vertex(center);
  legalize(mesh, pending, changed);
  return true;
}

}  // namespace driftmesh
