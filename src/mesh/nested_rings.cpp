#include "mesh/nested_rings.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/disjoint_sets.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// An area without segments inside; kNone: removed, that is outside or a hole.
enum class AreaId : std::int32_t {};
/// Segments that are connected with each other.
enum class GroupId : std::int32_t {};

class Nesting {
 public:
  explicit Nesting(const Triangulation& mesh) : mesh_(mesh), area_of_(mesh.triangles.size(), kNone) {
    group_segments();
    if (rings_ < 2) return;  // nothing but the outer boundary encloses anything
    flood_areas();
    find_surroundings();
    note_enclosed();
  }

  [[nodiscard]] NestedRings rings() {
    NestedRings result;
    if (rings_ < 2) return result;
    for (const GroupId g : ids_of(leftmost_))
      if (surrounding_[g] != kNone && encloses_[g] && !explained_[g]) result.unexplained.push_back(leftmost_[g]);
    for (const AreaId a : ids_of(largest_))
      if (!labeled(largest_[a]) && depth(a) % 2 == 0) result.alternating_holes.push_back(center(largest_[a]));
    return result;
  }

 private:
  [[nodiscard]] std::size_t group_count() const { return leftmost_.size(); }
  [[nodiscard]] const Point& at(VertexId v) const { return mesh_.points[v]; }
  [[nodiscard]] bool labeled(TriangleId t) const { return !mesh_.region.empty() && mesh_.region[t] != 0; }
  [[nodiscard]] AreaId area(HalfEdge h) const { return h == kNone ? AreaId{kNone} : area_of_[triangle_of(h)]; }
  [[nodiscard]] double size(TriangleId t) const {
    return signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }
  [[nodiscard]] Point center(TriangleId t) const {
    const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
    return {a.x + ((b.x - a.x) + (c.x - a.x)) / 3, a.y + ((b.y - a.y) + (c.y - a.y)) / 3};
  }

  /// Or below, on one vertical line.
  static bool is_left_of(const Point& p, const Point& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; }

  void group_segments() {
    DisjointSets<VertexId> sets(mesh_.points.size());
    std::vector<VertexId> closed;  // a vertex of each ring
    for (const RootSegment& root : mesh_.roots)
      if (!sets.join(root.vertex[0], root.vertex[1])) closed.push_back(root.vertex[0]);
    for (VertexId& v : closed) v = sets.find(v);
    std::sort(closed.begin(), closed.end());
    rings_ = std::unique(closed.begin(), closed.end()) - closed.begin();
    if (rings_ < 2) return;
    IdVector<VertexId, GroupId> group_of(mesh_.points.size(), kNone);
    for (const RootSegment& root : mesh_.roots) {
      GroupId& group = group_of[sets.find(root.vertex[0])];
      if (group == kNone) {
        group = leftmost_.next_id();
        leftmost_.push_back(root.vertex[0]);
      }
      for (const VertexId v : root.vertex)
        if (is_left_of(at(v), at(leftmost_[group]))) leftmost_[group] = v;
      group_of_root_.push_back(group);
    }
  }

  void flood_areas() {
    std::vector<TriangleId> stack;
    for (const TriangleId first : ids_of(mesh_.triangles)) {
      if (!mesh_.triangles[first].alive() || area_of_[first] != kNone) continue;
      const AreaId area = largest_.next_id();
      largest_.push_back(first);
      area_of_[first] = area;
      stack.push_back(first);
      double largest = 0;
      while (!stack.empty()) {
        const TriangleId t = stack.back();
        stack.pop_back();
        if (const double here = size(t); here > largest) {
          largest = here;
          largest_[area] = t;
        }
        for (const HalfEdge h : mesh_.triangles[t].neighbor)
          if (!is_constrained(h) && area_of_[triangle_of(h)] == kNone) {
            area_of_[triangle_of(h)] = area;
            stack.push_back(triangle_of(h));
          }
      }
    }
  }

  /// What lies west of a group's leftmost vertex lies around the group.
  void find_surroundings() {
    surrounding_.assign(group_count(), kNone);
    IdVector<VertexId, GroupId> led_by(mesh_.points.size(), kNone);
    for (const GroupId g : ids_of(leftmost_)) led_by[leftmost_[g]] = g;
    for (const TriangleId t : ids_of(mesh_.triangles))
      for (int i = 0; i < 3 && mesh_.triangles[t].alive(); ++i)
        if (const GroupId g = led_by[mesh_.triangles[t].vertex[i]]; g != kNone && reaches_west(t, i))
          surrounding_[g] = area_of_[t];
  }

  /// Whether the corner of a triangle opens to the west: upward and downward edges count as east of it.
  [[nodiscard]] bool reaches_west(TriangleId t, int i) const {
    const Point &o = mesh_.corner(t, i), &from = mesh_.corner(t, next(i)), &to = mesh_.corner(t, previous(i));
    const Point west{o.x - std::max({std::abs(o.x), std::abs(from.x - o.x), std::abs(to.x - o.x)}) - 1e-300, o.y};
    return west.x < o.x && orient2d(o, from, west) >= 0 && orient2d(o, west, to) > 0;
  }

  void note_enclosed() {
    encloses_.assign(group_count(), false);
    explained_.assign(group_count(), false);
    enclosing_.assign(largest_.size(), kNone);
    for (const RootId r : ids_of(mesh_.roots)) {
      const GroupId g = group_of_root_[to_index(r)];
      for (const HalfEdge h : mesh_.subsegments[mesh_.roots[r].tree].half) {
        const AreaId side = area(h);
        if (side == surrounding_[g]) continue;
        encloses_[g] = true;
        if (side == kNone || labeled(triangle_of(h))) explained_[g] = true;
        if (side != kNone) enclosing_[side] = g;
      }
    }
  }

  /// The number of groups around an area.
  [[nodiscard]] int depth(AreaId a) const {
    int groups = 0;
    while (a != kNone && enclosing_[a] != kNone) {
      ++groups;
      a = surrounding_[enclosing_[a]];
    }
    return groups;
  }

  const Triangulation& mesh_;
  std::ptrdiff_t rings_ = 0;  // groups with a ring
  std::vector<GroupId> group_of_root_;
  IdVector<GroupId, VertexId> leftmost_;
  IdVector<GroupId, AreaId> surrounding_;
  IdVector<GroupId, bool> encloses_;   // an area, or a hole
  IdVector<GroupId, bool> explained_;  // by a hole or a region point inside
  IdVector<TriangleId, AreaId> area_of_;
  IdVector<AreaId, TriangleId> largest_;  // triangle of each area
  IdVector<AreaId, GroupId> enclosing_;
};

}  // namespace

NestedRings find_nested_rings(const Triangulation& carved) {
  return Nesting(carved).rings();
}

}  // namespace driftmesh
