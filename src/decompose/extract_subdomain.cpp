#include "decompose/extract_subdomain.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// Where a root of the subdomain is in the mesh that it is taken from.
struct RootPlace {
  SubsegmentId node = kNone;  ///< whose ends are those of the root
  bool reversed = false;      ///< whether the root has the other direction
};

class Extraction {
 public:
  Extraction(const SubdomainMesh& from, const RenamedRoots& renamed, const Decomposition& now, SubdomainId s)
      : old_(from.mesh), from_(from), now_(now), s_(s), new_vertex_(old_.points.size(), kNone) {
    made_.part.roots.assign(now.roots_of(s).begin(), now.roots_of(s).end());
    made_.part.points = points_of(now, s);
    find_roots(renamed);
  }

  ExtractedSubdomain extracted() {
    const IdVector<TriangleId, bool> inside = flood();
    place_points();
    place_other_vertices(inside);
    plant_trees();
    place_triangles(inside);
    check_sides();
    return std::move(made_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error("subdomain " + to_string(s_) + " cannot be taken from the mesh that contains it: " + why +
                "; the changed decomposition does not continue the one that the mesh was made with");
  }

  [[nodiscard]] const Decomposition::Root& root(RootId r) const { return now_.roots[made_.part.roots[r]]; }

  void find_roots(const RenamedRoots& renamed) {
    place_.resize(made_.part.roots.size());
    for (const RootId r : ids_of(from_.roots)) {
      const auto chain = renamed.find(from_.roots[r]);
      if (chain == renamed.end()) {
        note_root(from_.roots[r], old_.roots[r].tree);
        continue;
      }
      for (const RootInterval& piece : chain->second) {
        const SubsegmentId node = old_.descend(r, piece.interval);
        if (old_.subsegments[node].path != piece.interval)
          refuse("root " + to_string(chain->first) + " is broken at a point that the mesh does not have, an end of " +
                 "interval " + std::to_string(piece.interval));
        note_root(piece.root, node);
      }
    }
    for (const RootId r : ids_of(place_))
      if (place_[r].node == kNone) refuse("the mesh does not have root " + to_string(made_.part.roots[r]));
  }

  /// Other roots are those of other parts of the mesh.
  void note_root(GlobalRootId name, SubsegmentId node) {
    const auto& roots = made_.part.roots;
    const auto found = std::lower_bound(roots.begin(), roots.end(), name);
    if (found == roots.end() || *found != name) return;
    const auto [first, second] = old_.subsegments[node].vertex;
    const Point &a = now_.points[now_.roots[name].a], &b = now_.points[now_.roots[name].b];
    const bool reversed = a == old_.points[second] && b == old_.points[first];
    if (!reversed && !(a == old_.points[first] && b == old_.points[second]))
      refuse("root " + to_string(name) + " has other ends there");
    place_[static_cast<RootId>(found - roots.begin())] = {node, reversed};
  }

  /// The triangles between the roots of the subdomain: no others separate those of a mesh.
  [[nodiscard]] IdVector<TriangleId, bool> flood() const {
    IdVector<TriangleId, bool> inside(old_.triangles.size(), false);
    std::vector<TriangleId> reached;
    const auto reach = [&](HalfEdge h) {
      if (inside[triangle_of(h)]) return;
      inside[triangle_of(h)] = true;
      reached.push_back(triangle_of(h));
    };
    for (const RootId r : ids_of(place_)) {
      const std::array<SubdomainId, 2> sides{root(r).left, root(r).right};
      visit_leaves(place_[r].node, [&](const Subsegment& leaf) {
        for (const std::size_t side : {0U, 1U}) {
          if (sides[side] != s_) continue;
          const HalfEdge h = leaf.half[place_[r].reversed ? 1 - side : side];
          if (h == kNone) refuse("the mesh has no triangles on a side of root " + to_string(made_.part.roots[r]));
          reach(h);
        }
      });
    }
    while (!reached.empty()) {
      const TriangleId t = reached.back();
      reached.pop_back();
      for (const HalfEdge h : old_.triangles[t].neighbor)
        if (!is_constrained(h)) reach(h);
    }
    return inside;
  }

  template <class Visit>
  void visit_leaves(SubsegmentId node, const Visit& visit) const {
    const Subsegment& segment = old_.subsegments[node];
    if (segment.is_leaf()) return visit(segment);
    visit_leaves(segment.child, visit);
    visit_leaves(segment.second_child(), visit);
  }

  /// Points of the decomposition.
  void place_points() {
    const auto& points = made_.part.points;
    made_.vertex.assign(points.size(), kNone);
    const auto place = [&](GlobalPointId point, VertexId old) {
      made_.vertex[static_cast<VertexId>(std::lower_bound(points.begin(), points.end(), point) - points.begin())] = old;
    };
    for (const VertexId v : ids_of(from_.points))
      if (std::binary_search(points.begin(), points.end(), from_.points[v])) place(from_.points[v], v);
    for (const RootId r : ids_of(place_)) {
      const auto& ends = old_.subsegments[place_[r].node].vertex;
      place(root(r).a, ends[place_[r].reversed ? 1 : 0]);
      place(root(r).b, ends[place_[r].reversed ? 0 : 1]);
    }
    for (const VertexId v : ids_of(points)) {
      if (made_.vertex[v] == kNone) refuse("the mesh does not have point " + to_string(points[v]));
      new_vertex_[made_.vertex[v]] = v;
      made_.part.mesh.points.push_back(now_.points[points[v]]);
      made_.part.mesh.origin.push_back(origin_of(now_, points[v]));
    }
  }

  void place_other_vertices(const IdVector<TriangleId, bool>& inside) {
    IdVector<VertexId, bool> used(old_.points.size(), false);
    for (const TriangleId t : ids_of(inside))
      if (inside[t])
        for (const VertexId v : old_.triangles[t].vertex) used[v] = true;
    for (const VertexId v : ids_of(used)) {
      if (!used[v] || new_vertex_[v] != kNone) continue;
      if (old_.origin[v] != kFree && !is_midpoint(old_.origin[v]))
        refuse("it does not have vertex " + std::to_string(to_int(v)) + " of the mesh, which is a given point");
      new_vertex_[v] = made_.vertex.next_id();
      made_.vertex.push_back(v);
      made_.part.mesh.points.push_back(old_.points[v]);
      made_.part.mesh.origin.push_back(kFree);  // until a tree says that it is a midpoint
    }
  }

  void plant_trees() {
    Triangulation& mesh = made_.part.mesh;
    new_leaf_.assign(old_.subsegments.size(), kNone);
    for (const RootId r : ids_of(place_)) {
      auto [a, b] = old_.subsegments[place_[r].node].vertex;
      if (place_[r].reversed) std::swap(a, b);
      mesh.add_root(new_vertex_[a], new_vertex_[b], root(r).marker, root(r).shell);
    }
    for (const RootId r : ids_of(place_)) grow(place_[r].node, mesh.roots[r].tree, place_[r].reversed);
  }

  void grow(SubsegmentId old, SubsegmentId leaf, bool reversed) {
    const Subsegment& segment = old_.subsegments[old];
    if (segment.is_leaf()) {
      new_leaf_[old] = leaf;
      return;
    }
    const VertexId middle = new_vertex_[old_.subsegments[segment.child].vertex[1]];
    made_.part.mesh.origin[middle] = midpoint_of(leaf);
    const SubsegmentId child = made_.part.mesh.halve(leaf, middle);
    grow(segment.child, reversed ? after(child) : child, reversed);
    grow(segment.second_child(), reversed ? child : after(child), reversed);
  }

  void place_triangles(const IdVector<TriangleId, bool>& inside) {
    Triangulation& mesh = made_.part.mesh;
    IdVector<TriangleId, TriangleId> new_triangle(inside.size(), kNone);
    for (const TriangleId t : ids_of(inside)) {
      if (!inside[t]) continue;
      new_triangle[t] = made_.triangle.next_id();
      made_.triangle.push_back(t);
      if (!old_.region.empty()) mesh.region.push_back(old_.region[t]);
      Triangle triangle = old_.triangles[t];
      for (VertexId& v : triangle.vertex) v = new_vertex_[v];
      mesh.triangles.push_back(triangle);
    }
    for (const TriangleId t : ids_of(mesh.triangles))
      for (const int i : {0, 1, 2}) {
        const HalfEdge h = mesh.triangles[t].neighbor[i];
        if (!is_constrained(h)) {
          mesh.triangles[t].neighbor[i] = half_edge(new_triangle[triangle_of(h)], index_of(h));
          continue;
        }
        const SubsegmentId leaf = new_leaf_[subsegment_of(h)];
        if (leaf == kNone) {
          const RootId crossed = old_.subsegments[subsegment_of(h)].root;
          refuse("its triangles are at root " + to_string(from_.roots[crossed]) +
                 " of the mesh, which it does not have");
        }
        mesh.link(half_edge(t, i), constrained(leaf));
      }
  }

  void check_sides() const {
    for (const Subsegment& segment : made_.part.mesh.subsegments) {
      if (!segment.is_leaf()) continue;
      const std::array<SubdomainId, 2> sides{root(segment.root).left, root(segment.root).right};
      for (const std::size_t side : {0U, 1U})
        if ((segment.half[side] != kNone) != (sides[side] == s_))
          refuse("its roots do not separate it from what is across root " + to_string(made_.part.roots[segment.root]));
    }
  }

  const Triangulation& old_;
  const SubdomainMesh& from_;
  const Decomposition& now_;
  SubdomainId s_;
  IdVector<RootId, RootPlace> place_;  // for the roots of the subdomain
  IdVector<VertexId, VertexId> new_vertex_;
  IdVector<SubsegmentId, SubsegmentId> new_leaf_;
  ExtractedSubdomain made_;
};

}  // namespace

ExtractedSubdomain extract_subdomain(const SubdomainMesh& from, const RenamedRoots& renamed, const Decomposition& now,
                                     SubdomainId s) {
  return Extraction(from, renamed, now, s).extracted();
}

}  // namespace driftmesh
