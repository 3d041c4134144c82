#include "mesh/triangulation_fault.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

constexpr auto id = &Triangulation::id;

/// Whether `handle` names one of `count` things.
bool names(std::int32_t handle, std::size_t count) {
  return static_cast<std::uint32_t>(handle) < count;
}

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// next() and previous() as tables of two bits, for indices in no order: branches on them would be mispredicted.
std::size_t next_of_any(int i) {
  return (0b001001U >> (2 * i)) & 3U;
}
std::size_t previous_of_any(int i) {
  return (0b010010U >> (2 * i)) & 3U;
}

// ---- Vertices ----

bool is_in_range(const GrowingArray<Point>& points) {
  bool in_range = true;
  for (const Point& p : points)
    in_range &= (std::fabs(p.x) <= kMaxCoordinate) & (std::fabs(p.y) <= kMaxCoordinate);  // false for NaN
  return in_range;
}

/// Whether `list` names each of the `free_count` slots that `is_free` once.
template <class IsFree>
bool lists_once(const std::vector<std::int32_t>& list, std::size_t free_count, std::size_t slots, IsFree&& is_free) {
  if (list.size() != free_count) return false;
  std::vector<bool> seen(list.empty() ? 0 : slots, false);
  for (const std::int32_t slot : list) {
    if (!names(slot, slots) || !is_free(id(slot)) || seen[id(slot)]) return false;
    seen[id(slot)] = true;
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
  const auto is_free = [&](std::size_t v) { return mesh.origin[v] == kDeleted; };
  if (!lists_once(mesh.free_vertices, deleted, mesh.points.size(), is_free))
    return "the list of free vertices is wrong";
  return "";
}

// ---- Triangles ----

/// Whether half-edge h of a live triangle and leaf subsegment s are linked both ways.
bool are_linked(const Triangulation& mesh, SubsegmentId s, HalfEdge h) {
  if (!names(s, mesh.subsegments.size())) return false;
  const Subsegment& segment = mesh.subsegments[id(s)];
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
  std::int32_t out_of_range = 0, low_bits = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const auto [a, b, c] = triangle.vertex;
    if (a == kNone) [[unlikely]] {
      ++dead;
      continue;
    }
    out_of_range |= a | b | c | beyond(a) | beyond(b) | beyond(c);
    for (const HalfEdge g : triangle.neighbor) {
      if (static_cast<std::uint32_t>(g) >= edges) [[unlikely]] {
        if (!is_constrained(g) || !names(subsegment_of(g), mesh.subsegments.size())) return false;
      } else {
        low_bits |= g & (g + g);  // bit 1 if both low bits of g are set: edge 3
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
  const auto is_free = [&](std::size_t t) { return !mesh.triangles[t].alive(); };
  if (!lists_once(mesh.free_triangles, dead, mesh.triangles.size(), is_free))
    return "the list of free triangles is wrong";
  return "";
}

/// No branch depends on the order of the triangles: this visits every half-edge.
std::string triangle_fault(const Triangulation& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& own = mesh.triangles[t];
    if (!own.alive()) continue;
    const auto& v = own.vertex;
    if (!(orient2d(mesh.points[id(v[0])], mesh.points[id(v[1])], mesh.points[id(v[2])]) > 0))
      return "a triangle is not counterclockwise";
    std::int32_t differences = 0;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(static_cast<TriangleId>(t), i), g = own.neighbor[at(i)];
      if (is_constrained(g)) {
        if (!are_linked(mesh, subsegment_of(g), h)) return "a triangle and a subsegment are not linked both ways";
        continue;
      }
      const int j = index_of(g);
      const Triangle& other = mesh.triangles[id(triangle_of(g))];
      differences |= (other.neighbor[at(j)] ^ h) | (other.vertex[next_of_any(j)] ^ v[at(previous(i))]) |
                     (other.vertex[previous_of_any(j)] ^ v[at(next(i))]) | (other.alive() ? 0 : 1);
      differences |= mesh.origin[id(v[at(i)])] == kDeleted ? 1 : 0;
    }
    if (differences != 0) return "neighboring triangles are not linked both ways";
  }
  return "";
}

// ---- Subsegments ----

bool is_at_edge(const Triangulation& mesh, SubsegmentId s, int side) {
  const HalfEdge h = mesh.subsegments[id(s)].half[at(side)];
  if (h == kNone) return true;
  return h >= 0 && names(triangle_of(h), mesh.triangles.size()) && index_of(h) != 3 &&
         mesh.triangles[id(triangle_of(h))].alive() && mesh.twin(h) == constrained(s);
}

bool halves_are_right(const Triangulation& mesh, SubsegmentId s) {
  const Subsegment& whole = mesh.subsegments[id(s)];
  const SubsegmentId c = whole.child;
  if (c <= s || !names(c, mesh.subsegments.size() - 1) || dyadic::depth(whole.path) >= dyadic::kMaxDepth) return false;
  const Subsegment &first = mesh.subsegments[id(c)], &second = mesh.subsegments[id(c) + 1];
  const VertexId m = first.vertex[1];
  return first.root == whole.root && second.root == whole.root && first.path == dyadic::first_half(whole.path) &&
         second.path == dyadic::second_half(whole.path) && first.vertex[0] == whole.vertex[0] &&
         second.vertex[0] == m && second.vertex[1] == whole.vertex[1] && mesh.origin[id(m)] == ~s &&
         mesh.points[id(m)] == midpoint(mesh.points[id(whole.vertex[0])], mesh.points[id(whole.vertex[1])]);
}

bool ends_exist(const Triangulation& mesh, const std::array<VertexId, 2>& ends) {
  return std::all_of(ends.begin(), ends.end(), [&](VertexId v) {
    return names(v, mesh.points.size()) && mesh.origin[id(v)] != kDeleted && mesh.origin[id(v)] != kFree;
  });
}

std::string subsegment_fault(const Triangulation& mesh) {
  const std::size_t count = mesh.subsegments.size();
  std::vector<bool> reached(count, false);  // from its parent or its root
  for (std::size_t r = 0; r < mesh.roots.size(); ++r) {
    const RootSegment& root = mesh.roots[r];
    if (!names(root.tree, count) || reached[id(root.tree)]) return "a root has no tree";
    const Subsegment& tree = mesh.subsegments[id(root.tree)];
    if (tree.path != dyadic::kWhole || id(tree.root) != r || tree.vertex != root.vertex) return "a tree has no root";
    reached[id(root.tree)] = true;
  }
  for (const Subsegment& segment : mesh.subsegments)
    if (segment.path == 0 || !ends_exist(mesh, segment.vertex)) return "an end of a subsegment does not exist";
  for (std::size_t i = 0; i < count; ++i) {
    const auto s = static_cast<SubsegmentId>(i);
    if (mesh.subsegments[i].is_leaf()) {
      if (!is_at_edge(mesh, s, 0) || !is_at_edge(mesh, s, 1))
        return "a subsegment and a triangle are not linked both ways";
    } else {
      if (!halves_are_right(mesh, s)) return "the halves of a subsegment do not fit it";
      const std::size_t child = id(mesh.subsegments[i].child);
      if (reached[child] || reached[child + 1]) return "a subsegment lies in two trees";
      reached[child] = reached[child + 1] = true;
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
