#include "mesh/triangulation_fault.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

/// next() and previous() as tables of two bits, for indices in no order: branches on them would be mispredicted.
std::size_t next_of_any(int i) {
  return (0b001001U >> (2 * i)) & 3U;
}
std::size_t previous_of_any(int i) {
  return (0b010010U >> (2 * i)) & 3U;
}

/// 0 for equal handles: to compare many without a branch.
template <IsId Id>
std::int32_t difference(Id a, Id b) {
  return to_int(a) ^ to_int(b);
}

// ---- Vertices ----

bool is_in_range(const GrowingArray<Point, VertexId>& points) {
  bool in_range = true;
  for (const Point& p : points)
    in_range &= (std::fabs(p.x) <= kMaxCoordinate) & (std::fabs(p.y) <= kMaxCoordinate);  // false for NaN
  return in_range;
}

/// Whether `list` names each of the `free_count` slots that `is_free` once, of `slots` in all.
template <class Id, class IsFree>
bool lists_once(const std::vector<Id>& list, std::size_t free_count, std::size_t slots, IsFree&& is_free) {
  if (list.size() != free_count) return false;
  IdVector<Id, bool> seen(list.empty() ? 0 : slots, false);
  for (const Id slot : list) {
    if (!seen.has(slot) || !is_free(slot) || seen[slot]) return false;
    seen[slot] = true;
  }
  return true;
}

std::string vertex_fault(const Triangulation& mesh) {
  if (mesh.origin.size() != mesh.points.size()) return "the numbers of points and origins differ";
  if (!is_in_range(mesh.points)) return "a coordinate is out of range";
  const auto lowest = -static_cast<std::int64_t>(mesh.subsegments.size());  // ~s of the last subsegment
  std::size_t deleted = 0;
  bool exist = true;
  for (const VertexOrigin o : mesh.origin) {
    exist &= o >= lowest;
    deleted += o == kDeleted;
  }
  if (!exist) return "a vertex is the midpoint of a subsegment that does not exist";
  const auto is_free = [&](VertexId v) { return mesh.origin[v] == kDeleted; };
  if (!lists_once(mesh.free_vertices, deleted, mesh.points.size(), is_free))
    return "the list of free vertices is wrong";
  return "";
}

// ---- Triangles ----

/// Whether half-edge h of a live triangle and leaf subsegment s are linked both ways.
bool are_linked(const Triangulation& mesh, SubsegmentId s, HalfEdge h) {
  if (!mesh.subsegments.has(s)) return false;
  const Subsegment& segment = mesh.subsegments[s];
  const VertexId a = mesh.edge_start(h), b = mesh.edge_end(h);
  return segment.is_leaf() && ((segment.half[0] == h && segment.vertex[0] == a && segment.vertex[1] == b) ||
                               (segment.half[1] == h && segment.vertex[1] == a && segment.vertex[0] == b));
}

/// Whether all corners and neighbors are in range. Signs and bits are collected and examined once at the end.
/// `dead` receives the number of free slots.
bool handles_exist(const Triangulation& mesh, std::size_t& dead) {
  const auto edges = static_cast<std::uint32_t>(4 * mesh.triangles.size());
  const auto last_vertex = static_cast<std::int32_t>(mesh.points.size()) - 1;
  // Negative for a vertex past the last; what a negative one gives does not matter, but must not overflow.
  const auto beyond = [last = static_cast<std::uint32_t>(last_vertex)](VertexId v) {
    return static_cast<std::int32_t>(last - static_cast<std::uint32_t>(v));
  };
  std::int32_t out_of_range = 0;
  std::uint32_t low_bits = 0;
  for (const Triangle& triangle : mesh.triangles) {
    if (!triangle.alive()) [[unlikely]] {
      ++dead;
      continue;
    }
    const auto [a, b, c] = triangle.vertex;
    out_of_range |= to_int(a) | to_int(b) | to_int(c) | beyond(a) | beyond(b) | beyond(c);
    for (const HalfEdge g : triangle.neighbor) {
      const auto bits = static_cast<std::uint32_t>(g);
      if (bits >= edges) [[unlikely]] {
        if (!is_constrained(g) || !mesh.subsegments.has(subsegment_of(g))) return false;
      } else {
        low_bits |= bits & (bits + bits);  // bit 1 if both low bits of g are set: edge 3
      }
    }
  }
  return out_of_range >= 0 && (low_bits & 2) == 0;
}

std::string array_fault(const Triangulation& mesh) {
  if (static_cast<std::int64_t>(mesh.triangles.size()) > kMaxTriangles) return "too many triangles";
  if (!mesh.region.empty() && mesh.region.size() != mesh.triangles.size())
    return "the numbers of triangles and regions differ";
  std::size_t dead = 0;
  if (!handles_exist(mesh, dead)) return "a corner or neighbor of a triangle does not exist";
  const auto is_free = [&](TriangleId t) { return !mesh.triangles[t].alive(); };
  if (!lists_once(mesh.free_triangles, dead, mesh.triangles.size(), is_free))
    return "the list of free triangles is wrong";
  return "";
}

/// No branch depends on the order of the triangles: this visits every half-edge.
std::string triangle_fault(const Triangulation& mesh) {
  for (const TriangleId t : ids_of(mesh.triangles)) {
    const Triangle& own = mesh.triangles[t];
    if (!own.alive()) continue;
    const auto& v = own.vertex;
    if (!(orient2d(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]) > 0))
      return "a triangle is not counterclockwise";
    std::int32_t differences = 0;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i), g = own.neighbor[i];
      if (is_constrained(g)) {
        if (!are_linked(mesh, subsegment_of(g), h)) return "a triangle and a subsegment are not linked both ways";
        continue;
      }
      const int j = index_of(g);
      const Triangle& other = mesh.triangles[triangle_of(g)];
      differences |= difference(other.neighbor[j], h) | difference(other.vertex[next_of_any(j)], v[previous(i)]) |
                     difference(other.vertex[previous_of_any(j)], v[next(i)]) | (other.alive() ? 0 : 1);
      differences |= mesh.origin[v[i]] == kDeleted ? 1 : 0;
    }
    if (differences != 0) return "neighboring triangles are not linked both ways";
  }
  return "";
}

// ---- Subsegments ----

bool is_at_edge(const Triangulation& mesh, SubsegmentId s, int side) {
  const HalfEdge h = mesh.subsegments[s].half[side];
  if (h == kNone) return true;
  return !is_constrained(h) && mesh.triangles.has(triangle_of(h)) && index_of(h) != 3 &&
         mesh.triangles[triangle_of(h)].alive() && mesh.twin(h) == constrained(s);
}

bool halves_are_right(const Triangulation& mesh, SubsegmentId s) {
  const Subsegment& whole = mesh.subsegments[s];
  const SubsegmentId c = whole.child;
  if (c <= s || !mesh.subsegments.has(c) || !mesh.subsegments.has(after(c))) return false;
  if (dyadic::depth(whole.path) >= dyadic::kMaxDepth) return false;
  const Subsegment &first = mesh.subsegments[c], &second = mesh.subsegments[after(c)];
  const VertexId m = first.vertex[1];
  return first.root == whole.root && second.root == whole.root && first.path == dyadic::first_half(whole.path) &&
         second.path == dyadic::second_half(whole.path) && first.vertex[0] == whole.vertex[0] &&
         second.vertex[0] == m && second.vertex[1] == whole.vertex[1] && mesh.origin[m] == midpoint_of(s) &&
         mesh.points[m] == midpoint(mesh.points[whole.vertex[0]], mesh.points[whole.vertex[1]]);
}

bool ends_exist(const Triangulation& mesh, const std::array<VertexId, 2>& ends) {
  return std::all_of(ends.begin(), ends.end(), [&](VertexId v) {
    return mesh.points.has(v) && mesh.origin[v] != kDeleted && mesh.origin[v] != kFree;
  });
}

std::string subsegment_fault(const Triangulation& mesh) {
  IdVector<SubsegmentId, bool> reached(mesh.subsegments.size(), false);  // from its parent or its root
  for (const RootId r : ids_of(mesh.roots)) {
    const RootSegment& root = mesh.roots[r];
    if (!reached.has(root.tree) || reached[root.tree]) return "a root has no tree";
    const Subsegment& tree = mesh.subsegments[root.tree];
    if (tree.path != dyadic::kWhole || tree.root != r || tree.vertex != root.vertex) return "a tree has no root";
    reached[root.tree] = true;
  }
  for (const Subsegment& segment : mesh.subsegments)
    if (segment.path == 0 || !ends_exist(mesh, segment.vertex)) return "an end of a subsegment does not exist";
  for (const SubsegmentId s : ids_of(mesh.subsegments)) {
    if (mesh.subsegments[s].is_leaf()) {
      if (!is_at_edge(mesh, s, 0) || !is_at_edge(mesh, s, 1))
        return "a subsegment and a triangle are not linked both ways";
    } else {
      if (!halves_are_right(mesh, s)) return "the halves of a subsegment do not fit it";
      const SubsegmentId first = mesh.subsegments[s].child, second = mesh.subsegments[s].second_child();
      if (reached[first] || reached[second]) return "a subsegment lies in two trees";
      reached[first] = reached[second] = true;
    }
  }
  if (std::find(reached.begin(), reached.end(), false) != reached.end()) return "a subsegment lies in no tree";
  return "";
}

}  // namespace

std::string triangulation_fault(const Triangulation& mesh) {
  for (const auto look : {vertex_fault, array_fault, subsegment_fault, triangle_fault})
    if (std::string fault = look(mesh); !fault.empty()) return fault;
  return "";
}

}  // namespace driftmesh
