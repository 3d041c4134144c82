#include "mesh/nested_rings.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "geometry/predicates.hpp"
#include "mesh/areas.hpp"
#include "mesh/blocks.hpp"

namespace driftmesh {
namespace {

bool has_several_rings(const Triangulation& mesh) {
  DisjointSets<VertexId> sets(mesh.points.size());
  return std::ranges::count_if(mesh.roots,
                               [&](const RootSegment& root) { return !sets.join(root.vertex[0], root.vertex[1]); }) > 1;
}

Blocks blocks_of_segments(const Triangulation& mesh) {
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const RootSegment& root : mesh.roots) edges.push_back({to_int(root.vertex[0]), to_int(root.vertex[1])});
  return blocks_of(mesh.points.size(), edges);
}

/// What rings enclose, by their blocks: rings that touch at a point are blocks of their own. A block has one area
/// around it, and each area inside a block has one innermost block around itself.
class Nesting {
 public:
  explicit Nesting(const Triangulation& mesh) : mesh_(mesh), areas_(mesh), blocks_(blocks_of_segments(mesh)) {
    find_surroundings();
    note_enclosed();
    for (const BlockId b : ids_of(blocks_.edges))
      if (is_even(b)) alternate(b);
  }

  [[nodiscard]] NestedRings rings() const {
    NestedRings result;
    result.unexplained = unexplained();
    for (const AreaId a : areas_.ids())
      if (const TriangleId t = areas_.largest(a); !labeled(t) && is_hole(a))
        result.alternating_holes.push_back(center_of(mesh_, t));
    return result;
  }

 private:
  /// The leftmost vertices of connected groups of blocks, none of them explained or bordering on the outside.
  [[nodiscard]] std::vector<VertexId> unexplained() const {
    struct Group {
      VertexId leftmost = kNone;
      bool encloses = false;
      bool explained = false;
    };
    DisjointSets<VertexId> sets(mesh_.points.size());
    for (const RootSegment& root : mesh_.roots) sets.join(root.vertex[0], root.vertex[1]);
    IdVector<VertexId, std::int32_t> group_of(mesh_.points.size(), kNone);
    std::vector<Group> groups;  // in the order of their first segments
    for (const BlockId b : ids_of(blocks_.edges)) {
      std::int32_t& known = group_of[sets.find(leftmost_[b])];
      if (known == kNone) {
        known = static_cast<std::int32_t>(groups.size());
        groups.push_back({leftmost_[b]});
      }
      Group& group = groups[to_index(known)];
      if (is_left_of(at(leftmost_[b]), at(group.leftmost))) group.leftmost = leftmost_[b];
      group.encloses = group.encloses || encloses_[b];
      group.explained = group.explained || explained_[b] || surrounding_[b] == kNone;
    }
    std::vector<VertexId> found;
    for (const Group& group : groups)
      if (group.encloses && !group.explained) found.push_back(group.leftmost);
    return found;
  }

  [[nodiscard]] const Point& at(VertexId v) const { return mesh_.points[v]; }
  [[nodiscard]] bool labeled(TriangleId t) const { return !mesh_.region.empty() && mesh_.region[t] != 0; }
  [[nodiscard]] const RootSegment& root(std::int32_t edge) const { return mesh_.roots[RootId{edge}]; }
  [[nodiscard]] const std::array<HalfEdge, 2>& halves(std::int32_t edge) const {
    return mesh_.subsegments[root(edge).tree].half;
  }
  /// The areas left and right of a segment in its direction.
  [[nodiscard]] std::array<AreaId, 2> sides(std::int32_t edge) const {
    return {areas_.of(halves(edge)[0]), areas_.of(halves(edge)[1])};
  }

  /// Or below, on one vertical line.
  static bool is_left_of(const Point& p, const Point& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; }

  /// All segments of a block at its leftmost vertex lead east. What lies around the block is on the right of the
  /// southernmost one.
  void find_surroundings() {
    for (const std::vector<std::int32_t>& edges : blocks_.edges) {
      VertexId left = root(edges[0]).vertex[0];
      for (const std::int32_t e : edges)
        for (const VertexId v : root(e).vertex)
          if (is_left_of(at(v), at(left))) left = v;
      std::int32_t lowest = -1;
      VertexId end = kNone;
      for (const std::int32_t e : edges) {
        const auto [a, b] = root(e).vertex;
        if (a != left && b != left) continue;
        const VertexId other = a == left ? b : a;
        if (lowest < 0 || orient2d(at(left), at(end), at(other)) < 0) lowest = e, end = other;
      }
      leftmost_.push_back(left);
      surrounding_.push_back(sides(lowest)[root(lowest).vertex[0] == left ? 1 : 0]);
    }
  }

  void note_enclosed() {
    encloses_.assign(blocks_.edges.size(), false);
    explained_.assign(blocks_.edges.size(), false);
    enclosing_.assign(areas_.count(), kNone);
    odd_.assign(areas_.count(), true);
    alternates_.assign(areas_.count(), false);
    for (const BlockId b : ids_of(blocks_.edges))
      for (const std::int32_t e : blocks_.edges[b])
        for (const HalfEdge h : halves(e)) {
          const AreaId side = areas_.of(h);
          if (side == surrounding_[b]) continue;
          encloses_[b] = true;
          if (side == kNone || labeled(triangle_of(h))) explained_[b] = true;
          if (side != kNone) enclosing_[side] = b;
        }
  }

  /// Whether a block consists of several rings that touch or cross, but share no segment: it has more segments than
  /// vertices, and an even number at each.
  [[nodiscard]] bool is_even(BlockId b) const {
    std::vector<VertexId> ends;
    for (const std::int32_t e : blocks_.edges[b])
      for (const VertexId v : root(e).vertex) ends.push_back(v);
    std::ranges::sort(ends);
    bool several = false;
    for (auto first = ends.begin(); first != ends.end();) {
      const auto last = std::upper_bound(first, ends.end(), *first);
      if ((last - first) % 2 != 0) return false;
      several = several || last - first > 2;
      first = last;
    }
    return several;
  }

  /// Each segment of an even block has an even number of its rings around one side, and an odd number around the other.
  void alternate(BlockId b) {
    std::vector<std::pair<AreaId, AreaId>> steps;
    for (const std::int32_t e : blocks_.edges[b]) {
      const auto [left, right] = sides(e);
      steps.emplace_back(left, right);
      steps.emplace_back(right, left);
    }
    std::ranges::sort(steps);
    std::vector<std::pair<AreaId, bool>> stack{{surrounding_[b], false}};
    while (!stack.empty()) {
      const auto [area, odd] = stack.back();
      stack.pop_back();
      for (auto step = std::ranges::lower_bound(steps, area, {}, &std::pair<AreaId, AreaId>::first);
           step != steps.end() && step->first == area; ++step) {
        const AreaId to = step->second;
        if (to == kNone || to == surrounding_[b] || alternates_[to]) continue;
        alternates_[to] = true;
        odd_[to] = !odd;
        stack.emplace_back(to, !odd);
      }
    }
  }

  [[nodiscard]] bool is_hole(AreaId a) const {
    bool odd = false;
    for (; a != kNone && enclosing_[a] != kNone; a = surrounding_[enclosing_[a]]) odd = odd != odd_[a];
    return !odd;
  }

  const Triangulation& mesh_;
  Areas areas_;
  Blocks blocks_;
  IdVector<BlockId, VertexId> leftmost_;
  IdVector<BlockId, AreaId> surrounding_;
  IdVector<BlockId, bool> encloses_;   // an area, or a hole
  IdVector<BlockId, bool> explained_;  // by a hole or a region point inside
  IdVector<AreaId, BlockId> enclosing_;
  IdVector<AreaId, bool> odd_;         // whether an odd number of the rings of the block around it enclose it
  IdVector<AreaId, bool> alternates_;  // whether that was decided segment by segment
};

}  // namespace

NestedRings find_nested_rings(const Triangulation& carved) {
  if (!has_several_rings(carved)) return {};  // nothing but the outer boundary encloses anything
  return Nesting(carved).rings();
}

}  // namespace driftmesh
