#include "decompose/bridges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "decompose/separator_room.hpp"
#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cavity.hpp"

namespace driftmesh {
namespace {

/// A triangulation whose walls are its constrained edges and those edges that have been declared bridges.
struct WalledMesh {
  Triangulation mesh;
  IdVector<HalfEdge, bool> bridge;

  explicit WalledMesh(const Triangulation& from) : mesh(from) {}

  [[nodiscard]] bool is_wall(HalfEdge h) const { return is_constrained(mesh.twin(h)) || bridge[h]; }
  /// The first wall that leaves the end of `h` when turning clockwise there, starting at `h`'s triangle.
  [[nodiscard]] HalfEdge next_wall(HalfEdge h) const {
    HalfEdge g = half_edge(triangle_of(h), next(index_of(h)));
    while (!is_wall(g)) {
      g = mesh.twin(g);
      g = half_edge(triangle_of(g), next(index_of(g)));
    }
    return g;
  }
  [[nodiscard]] const Point& at(VertexId v) const { return mesh.points[v]; }
};

/// Vertices that are connected by segments, and later by bridges.
using ConnectedVertices = DisjointSets<VertexId>;

ConnectedVertices connect_by_segments(const Triangulation& mesh) {
  ConnectedVertices sets(mesh.points.size());
  for (const RootSegment& root : mesh.roots) sets.join(root.vertex[0], root.vertex[1]);
  return sets;
}

/// Whether some edge joins points that segments do not connect.
bool needs_bridges(const Triangulation& mesh, ConnectedVertices& sets) {
  for (const Triangle& t : mesh.triangles)
    if (t.alive() &&
        (sets.find(t.vertex[0]) != sets.find(t.vertex[1]) || sets.find(t.vertex[0]) != sets.find(t.vertex[2])))
      return true;
  return false;
}

/// Cuts leaf `s` at `m`. Nothing happens if rounding leaves no room.
bool cut_leaf(Triangulation& mesh, Cavity& cavity, SubsegmentId s, const Point& m) {
  if (cavity.gather_on(s, m) != Cavity::Found::kClear) return false;
  const VertexId v = mesh.add_vertex(m, midpoint_of(s));
  const SubsegmentId first = mesh.halve(s, v);
  cavity.fill_on(v, first, after(first));
  return true;
}

/// Halves the leaves of straight segments until they are no longer than `spacing`.
void refine_borders(Triangulation& mesh, double spacing) {
  Cavity cavity(mesh);
  for (SubsegmentId s{0}; mesh.subsegments.has(s); s = after(s)) {  // including those added meanwhile
    const Subsegment leaf = mesh.subsegments[s];
    if (!leaf.is_leaf() || mesh.roots[leaf.root].shell != kNone) continue;
    const Point &a = mesh.points[leaf.vertex[0]], &b = mesh.points[leaf.vertex[1]];
    if (squared_distance(a, b) <= spacing * spacing) continue;
    cut_leaf(mesh, cavity, s, midpoint(a, b));
  }
}

/// The first number that no shell and no shell end has.
std::int32_t fresh_shell_name(const Triangulation& mesh) {
  std::int32_t name = 0;
  for (const RootSegment& root : mesh.roots) name = std::max(name, root.shell + 1);
  for (const VertexOrigin o : mesh.origin)
    if (is_shell_end(o)) name = std::max(name, o - kShellEnd + 1);
  return name;
}

/// Halves all roots of a shell: the halves are two new shells, which meet on a new circle.
bool halve_shell(Triangulation& mesh, Cavity& cavity, std::int32_t shell) {
  const std::int32_t name = fresh_shell_name(mesh);
  bool any = false;
  for (const RootId r : ids_of(mesh.roots)) {  // not those added meanwhile
    if (mesh.roots[r].shell != shell) continue;
    const SubsegmentId s = mesh.roots[r].tree;
    const auto [u, v] = mesh.roots[r].vertex;
    const Point m = midpoint(mesh.points[u], mesh.points[v]);
    if (cavity.gather_on(s, m) != Cavity::Found::kClear) continue;
    const VertexId middle = mesh.add_vertex(m, kShellEnd + name);
    const RootId outer = mesh.add_root(middle, v, mesh.roots[r].marker, name + 1);
    mesh.roots[r].vertex = mesh.subsegments[s].vertex = {u, middle};
    mesh.roots[r].shell = name;
    cavity.fill_on(middle, s, mesh.roots[outer].tree);
    any = true;
  }
  return any;
}

/// Whether an edge has the room that a separator needs. Walls that meet it are left to angle_at_start.
class RoomOfEdge {
 public:
  RoomOfEdge(const WalledMesh& walled, HalfEdge edge)
      : walled_(walled),
        from_(walled.mesh.edge_start(edge)),
        to_(walled.mesh.edge_end(edge)),
        room_(walled.at(from_), walled.at(to_)),
        is_free_(is_free_across(edge) && is_free_across(walled.mesh.twin(edge))) {}

  [[nodiscard]] bool is_free() const { return is_free_; }
  /// The wall that reaches into the room; kNone if none does, or a point was found first.
  [[nodiscard]] HalfEdge wall() const { return wall_; }

 private:
  /// In the triangle of `h`, and beyond its other sides.
  bool is_free_across(HalfEdge h) {
    return !room_.contains(walled_.at(walled_.mesh.apex(h))) &&
           is_free_beyond(half_edge(triangle_of(h), next(index_of(h)))) &&
           is_free_beyond(half_edge(triangle_of(h), previous(index_of(h))));
  }
  bool is_free_beyond(HalfEdge h) {
    const VertexId u = walled_.mesh.edge_start(h), v = walled_.mesh.edge_end(h);
    if (!room_.is_entered_by(walled_.at(u), walled_.at(v))) return true;
    if (!walled_.is_wall(h)) return is_free_across(walled_.mesh.twin(h));
    if (is_end(u) || is_end(v)) return true;
    wall_ = h;
    return false;
  }
  [[nodiscard]] bool is_end(VertexId v) const { return v == from_ || v == to_; }

  const WalledMesh& walled_;
  VertexId from_, to_;
  SeparatorRoom room_;
  HalfEdge wall_ = kNone;
  bool is_free_;
};

/// The segments next to points that no bridge connects to them yet.
struct Unreached {
  std::map<SubsegmentId, std::pair<double, Point>> feet;  ///< for each leaf, squared distance and foot of the nearest
  std::set<std::int32_t> shells;                          ///< those whose segments cannot be cut at a foot
};

/// Whether the perpendicular from w to segment ab meets it, and not so near to an end that a bridge to the end, which
/// makes an angle of at least `angle` with the segment, is as good.
bool deserves_foot(double along, const Point& w, const Point& a, const Point& b, double angle) {
  if (along > 0.02 && along < 0.98) return true;
  const double length = std::sqrt(squared_distance(a, b)), to_end = std::min(along, 1 - along) * length;
  return to_end > 0 && std::fabs(rounded_cross(a, b, w)) < std::tan(angle) * to_end * length;
}

class UnreachedSearch {
 public:
  UnreachedSearch(const WalledMesh& walled, ConnectedVertices& sets, double angle)
      : walled_(walled), mesh_(walled.mesh), sets_(sets), angle_(angle) {}

  Unreached run() {
    for (const TriangleId t : ids_of(mesh_.triangles))
      for (int i = 0; i < 3 && mesh_.triangles[t].alive(); ++i) {
        const HalfEdge h = half_edge(t, i);
        if (is_constrained(mesh_.twin(h)))
          consider(h, mesh_.apex(h));
        else if (sets_.find(mesh_.edge_start(h)) != sets_.find(mesh_.edge_end(h)))
          consider_wall_beside(h);
      }
    return std::move(found_);
  }

 private:
  /// A perpendicular from vertex v to the segment of half-edge h.
  void consider(HalfEdge h, VertexId v) {
    if (sets_.find(v) == sets_.find(mesh_.edge_start(h))) return;
    const SubsegmentId s = subsegment_of(mesh_.twin(h));
    const Point &a = mesh_.points[mesh_.edge_start(h)], &b = mesh_.points[mesh_.edge_end(h)];
    const Point& w = mesh_.points[v];
    const double along = ((w.x - a.x) * (b.x - a.x) + (w.y - a.y) * (b.y - a.y)) / squared_distance(a, b);
    if (!deserves_foot(along, w, a, b, angle_)) return;
    const std::int32_t shell = mesh_.roots[mesh_.subsegments[s].root].shell;
    if (shell != kNone) found_.shells.insert(shell);
    if (shell != kNone) return;
    const Point foot{snap_to_zero(a.x + along * (b.x - a.x)), snap_to_zero(a.y + along * (b.y - a.y))};
    const double distance = squared_distance(w, foot);
    const auto [entry, is_new] = found_.feet.try_emplace(s, distance, foot);
    if (!is_new && distance < entry->second.first) entry->second = {distance, foot};
  }

  /// The ends of an edge that is no bridge because of a segment beside it may reach that segment.
  void consider_wall_beside(HalfEdge edge) {
    const HalfEdge wall = RoomOfEdge(walled_, edge).wall();
    if (wall == kNone || !is_constrained(mesh_.twin(wall))) return;
    consider(wall, mesh_.edge_start(edge));
    consider(wall, mesh_.edge_end(edge));
  }

  const WalledMesh& walled_;
  const Triangulation& mesh_;
  ConnectedVertices& sets_;
  double angle_;
  Unreached found_;
};

/// Cuts segments at the feet of perpendiculars from points that no bridge connects to them yet: the shortest connection
/// of two parts of the border ends at such a foot or at a convex corner. Shell pieces are halved instead, if at all.
/// Returns whether anything was cut.
bool refine_unreached(WalledMesh& walled, ConnectedVertices& sets, double angle, bool may_halve_shells) {
  const Unreached found = UnreachedSearch(walled, sets, angle).run();
  Triangulation& mesh = walled.mesh;
  Cavity cavity(mesh);
  bool any = false;
  for (const auto& [s, foot] : found.feet) any |= cut_leaf(mesh, cavity, s, foot.second);
  if (!may_halve_shells) return any;
  for (const std::int32_t shell : found.shells) any |= halve_shell(mesh, cavity, shell);
  return any;
}

/// The smaller of the two angles between the edge and the walls next to it around its start.
double angle_at_start(const WalledMesh& walled, HalfEdge edge) {
  const Triangulation& mesh = walled.mesh;
  const VertexId u = mesh.edge_start(edge), v = mesh.edge_end(edge);
  const auto opening = [&](VertexId w, double sign) {
    const Point &o = walled.at(u), &p = walled.at(v), &q = walled.at(w);
    return sign * orient2d(o, p, q) <= 0 ? std::numbers::pi : angle_at(p, o, q);
  };
  double smallest = std::numbers::pi;
  for (HalfEdge h = edge;;) {  // counterclockwise
    const HalfEdge into = half_edge(triangle_of(h), previous(index_of(h)));
    if (walled.is_wall(into)) {
      smallest = std::min(smallest, opening(mesh.edge_start(into), 1));
      break;
    }
    h = mesh.twin(into);
    if (h == edge) return smallest;  // an isolated point
  }
  const HalfEdge wall = walled.next_wall(mesh.twin(edge));
  return std::min(smallest, opening(mesh.edge_end(wall), -1));
}

/// What bridges must keep.
struct BridgeRule {
  double angle;      ///< least angle with what they meet; radians
  bool room = true;  ///< whether they need that of separators
};

/// Adds bridges that keep the rule, the shortest first.
void choose_bridges(WalledMesh& walled, ConnectedVertices& sets, const BridgeRule& rule) {
  const Triangulation& mesh = walled.mesh;
  struct Candidate {
    double squared_length;
    HalfEdge edge;
  };
  std::vector<Candidate> candidates;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i);
      if (is_constrained(mesh.twin(h)) || mesh.twin(h) < h) continue;
      const VertexId u = mesh.edge_start(h), v = mesh.edge_end(h);
      if (sets.find(u) != sets.find(v)) candidates.push_back({squared_distance(walled.at(u), walled.at(v)), h});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.squared_length != b.squared_length ? a.squared_length < b.squared_length : a.edge < b.edge;
  });
  for (const Candidate& c : candidates) {
    const VertexId u = mesh.edge_start(c.edge), v = mesh.edge_end(c.edge);
    const HalfEdge back = mesh.twin(c.edge);
    if (sets.find(u) == sets.find(v)) continue;
    if (std::min(angle_at_start(walled, c.edge), angle_at_start(walled, back)) < rule.angle) continue;
    if (rule.room && !RoomOfEdge(walled, c.edge).is_free()) continue;
    sets.join(u, v);
    walled.bridge[c.edge] = walled.bridge[back] = true;
  }
}

/// Adds bridges until everything is connected. Where none keeps the rule, the border is refined further; smaller
/// angles, and in the end no rule at all, are the last resort. A leaf gets one foot in a round, so many points beside
/// one take many rounds. Each round in which shells are halved doubles their pieces.
void build_bridges(WalledMesh& walled, double angle) {
  constexpr int kRounds = 100, kRoundsOfShells = 7;
  ConnectedVertices sets(0);
  for (int round = 0; round < kRounds; ++round) {
    sets = ConnectedVertices(walled.mesh.points.size());
    for (const Subsegment& s : walled.mesh.subsegments)
      if (s.is_leaf()) sets.join(s.vertex[0], s.vertex[1]);
    walled.bridge.assign(4 * walled.mesh.triangles.size(), false);
    choose_bridges(walled, sets, {angle});
    if (!needs_bridges(walled.mesh, sets)) return;
    if (round + 1 < kRounds && !refine_unreached(walled, sets, angle, round < kRoundsOfShells)) break;
  }
  for (const double part : {0.9, 0.75, 0.5, 0.25}) choose_bridges(walled, sets, {part * angle});
  if (needs_bridges(walled.mesh, sets)) choose_bridges(walled, sets, {0, false});
}

/// Turns the walls of a triangulation into a map. Points that were put on segments as ends for bridges, but became
/// none, are left out.
class MapBuilder {
 public:
  MapBuilder(const WalledMesh& walled, std::size_t given_points)
      : walled_(walled),
        mesh_(walled.mesh),
        map_id_(mesh_.points.size(), kNone),
        side_of_(4 * mesh_.triangles.size(), kNone),
        used_(mesh_.points.size(), false) {
    for (const VertexId v : ids_of(used_)) used_[v] = to_index(v) < given_points || is_shell_end(mesh_.origin[v]);
    for (const HalfEdge h : ids_of(walled.bridge))
      if (walled.bridge[h]) used_[mesh_.edge_start(h)] = true;
  }

  PlanarMap build() {
    for (const VertexId v : ids_of(used_))
      if (used_[v])
        map_id_[v] = map_.add_point(mesh_.points[v], is_midpoint(mesh_.origin[v]) ? kNone : mesh_.origin[v]);
    for (const RootSegment& root : mesh_.roots) add_root(root);
    for (const HalfEdge h : ids_of(walled_.bridge)) add_bridge(h);
    for (const SideId s : ids_of(tail_))
      if (tail_[s] != kNone) map_.link(s, side_of_[walled_.next_wall(tail_[s])]);
    return std::move(map_);
  }

 private:
  void add_root(const RootSegment& root) {
    leaves_.clear();
    collect_leaves(root.tree);
    const PlanarMap::Wall wall{root.marker, root.shell, PlanarMap::Kind::kInput};
    for (std::size_t i = 0, j = 0; i < leaves_.size(); i = j) {
      const Subsegment& first = mesh_.subsegments[leaves_[i]];
      do ++j;
      while (j < leaves_.size() && !used_[mesh_.subsegments[leaves_[j]].vertex[0]]);
      const Subsegment& last = mesh_.subsegments[leaves_[j - 1]];
      const SideId s = map_.add_wall(map_id_[first.vertex[0]], map_id_[last.vertex[1]], wall);
      for (std::size_t k = i; k < j; ++k) {
        const auto& half = mesh_.subsegments[leaves_[k]].half;
        if (half[0] != kNone) side_of_[half[0]] = s;
        if (half[1] != kNone) side_of_[half[1]] = PlanarMap::twin(s);
      }
      set_tail(s, last.half[0]);
      set_tail(PlanarMap::twin(s), first.half[1]);
    }
  }

  void collect_leaves(SubsegmentId s) {
    const Subsegment& node = mesh_.subsegments[s];
    if (node.is_leaf()) {
      leaves_.push_back(s);
      return;
    }
    collect_leaves(node.child);
    collect_leaves(node.second_child());
  }

  void add_bridge(HalfEdge h) {
    if (!walled_.bridge[h] || side_of_[h] != kNone) return;
    const SideId s =
        map_.add_wall(map_id_[mesh_.edge_start(h)], map_id_[mesh_.edge_end(h)], {0, kNone, PlanarMap::Kind::kBridge});
    side_of_[h] = s;
    side_of_[mesh_.twin(h)] = PlanarMap::twin(s);
    set_tail(s, h);
    set_tail(PlanarMap::twin(s), mesh_.twin(h));
  }

  void set_tail(SideId s, HalfEdge h) {
    tail_.resize(map_.sides.size(), kNone);
    tail_[s] = h;
    if (h != kNone && !mesh_.region.empty()) map_.side(s).region = mesh_.region[triangle_of(h)];
  }

  const WalledMesh& walled_;
  const Triangulation& mesh_;
  PlanarMap map_;
  IdVector<VertexId, MapVertexId> map_id_;
  IdVector<HalfEdge, SideId> side_of_;
  IdVector<VertexId, bool> used_;
  IdVector<SideId, HalfEdge> tail_;  // the triangle edge that the side ends with
  std::vector<SubsegmentId> leaves_;
};

}  // namespace

PlanarMap connected_walls(const Triangulation& from, double spacing, double angle) {
  for (const Subsegment& s : from.subsegments)
    if (!s.is_leaf()) throw Error("cannot decompose a triangulation that has been refined");
  ConnectedVertices sets = connect_by_segments(from);
  WalledMesh walled(from);
  if (needs_bridges(from, sets)) {
    refine_borders(walled.mesh, spacing);
    build_bridges(walled, angle);
  } else {
    walled.bridge.resize(4 * walled.mesh.triangles.size(), false);
  }
  return MapBuilder(walled, from.points.size()).build();
}

}  // namespace driftmesh
