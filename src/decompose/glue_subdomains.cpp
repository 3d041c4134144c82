#include "decompose/glue_subdomains.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace driftmesh {
namespace {

class Gluing {
 public:
  Gluing(std::span<const SubdomainMesh* const> meshes, const JoinedSubdomains& joined, SubdomainId s)
      : joined_(joined), now_(joined.decomposition) {
    for (const SubdomainMesh* mesh : meshes)
      parts_.push_back({*mesh, IdVector<VertexId, VertexId>(mesh->mesh.points.size(), kNone),
                        IdVector<SubsegmentId, SubsegmentId>(mesh->mesh.subsegments.size(), kNone)});
    labeled_ = std::ranges::any_of(meshes, [](const SubdomainMesh* mesh) { return !mesh->mesh.region.empty(); });
    made_.part.roots.assign(now_.roots_of(s).begin(), now_.roots_of(s).end());
    made_.part.points = points_of(now_, s);
  }

  GluedSubdomain glued() {
    place_points();
    for (std::size_t k = 0; k < parts_.size(); ++k) place_other_vertices(k);
    plant_trees();
    for (std::size_t k = 0; k < parts_.size(); ++k) place_triangles(k);
    return std::move(made_);
  }

 private:
  struct Part {
    const SubdomainMesh& from;
    IdVector<VertexId, VertexId> new_vertex;
    IdVector<SubsegmentId, SubsegmentId> new_leaf;  // kNone: it is on a separator that is gone
  };
  static std::int32_t index_of_part(std::size_t k) { return static_cast<std::int32_t>(k); }
  /// A point, or an interval, of a root.
  using OnRoot = std::pair<GlobalRootId, dyadic::Path>;

  void place_points() {
    made_.vertex.resize(made_.part.points.size());
    for (const GlobalPointId v : made_.part.points) {
      made_.part.mesh.points.push_back(now_.points[v]);
      made_.part.mesh.origin.push_back(origin_of(now_, v));
    }
  }

  VertexId add_vertex(std::size_t k, VertexId v) {
    made_.part.mesh.points.push_back(parts_[k].from.mesh.points[v]);
    made_.part.mesh.origin.push_back(kFree);  // until a tree says that it is a midpoint
    made_.vertex.push_back({index_of_part(k), v});
    return static_cast<VertexId>(made_.part.mesh.points.size() - 1);
  }

  /// A vertex of which others may have a copy, which is at the same place.
  void place_shared(std::size_t k, VertexId v, VertexId& place) {
    if (place == kNone) place = add_vertex(k, v);
    parts_[k].new_vertex[v] = place;
  }

  void place_other_vertices(std::size_t k) {
    Part& part = parts_[k];
    const Triangulation& old = part.from.mesh;
    for (const VertexId v : ids_of(old.points)) {
      if (old.origin[v] == kDeleted) continue;
      if (part.from.points.has(v)) {
        place_known(k, v, part.from.points[v]);
      } else if (is_midpoint(old.origin[v])) {
        const Subsegment& halved = old.subsegments[halved_by(old.origin[v])];
        place_shared(k, v, midpoints_.try_emplace({part.from.roots[halved.root], halved.path}, kNone).first->second);
      } else {
        part.new_vertex[v] = add_vertex(k, v);
      }
    }
  }

  void place_known(std::size_t k, VertexId v, GlobalPointId was) {
    const GlobalPointId point = joined_.points[was].point;
    if (point == kNoPoint) {
      place_shared(k, v, gone_.try_emplace(was, kNone).first->second);
      if (joined_.points[was].halved.root != kNone)
        middles_[{joined_.points[was].halved.root, joined_.points[was].halved.interval}] = parts_[k].new_vertex[v];
      return;
    }
    const VertexId place = vertex_of(point);
    parts_[k].new_vertex[v] = place;
    if (made_.vertex[place].mesh == kNone) made_.vertex[place] = {index_of_part(k), v};
  }

  void plant_trees() {
    Triangulation& mesh = made_.part.mesh;
    for (const GlobalRootId r : made_.part.roots) {
      const Decomposition::Root& root = now_.roots[r];
      mesh.add_root(vertex_of(root.a), vertex_of(root.b), root.marker, root.shell);
    }
    for (const auto& [interval, middle] : middles_)  // those that contain others first
      (void)halved(mesh.descend(root_of(interval.first), interval.second), middle);
    for (Part& part : parts_)
      for (const RootId r : ids_of(part.from.roots)) {
        const RootInterval& now = joined_.roots[part.from.roots[r]];
        if (now.root == kNone) continue;
        const SubsegmentId node = mesh.descend(root_of(now.root), now.interval);
        const SubsegmentId tree = part.from.mesh.roots[r].tree;
        const VertexId start = part.new_vertex[part.from.mesh.subsegments[tree].vertex[0]];
        grow(part, tree, node, mesh.subsegments[node].vertex[0] != start);
      }
  }

  [[nodiscard]] VertexId vertex_of(GlobalPointId point) const {
    return static_cast<VertexId>(std::ranges::lower_bound(made_.part.points, point) - made_.part.points.begin());
  }
  [[nodiscard]] RootId root_of(GlobalRootId root) const {
    return static_cast<RootId>(std::ranges::lower_bound(made_.part.roots, root) - made_.part.roots.begin());
  }

  /// The first half of a node, which becomes two unless it is.
  SubsegmentId halved(SubsegmentId node, VertexId middle) {
    Triangulation& mesh = made_.part.mesh;
    if (!mesh.subsegments[node].is_leaf()) return mesh.subsegments[node].child;
    mesh.origin[middle] = midpoint_of(node);
    return mesh.halve(node, middle);
  }

  void grow(Part& part, SubsegmentId old, SubsegmentId node, bool reversed) {
    const Subsegment& segment = part.from.mesh.subsegments[old];
    if (segment.is_leaf()) {
      part.new_leaf[old] = node;
      return;
    }
    const SubsegmentId child = halved(node, part.new_vertex[part.from.mesh.subsegments[segment.child].vertex[1]]);
    grow(part, segment.child, reversed ? after(child) : child, reversed);
    grow(part, segment.second_child(), reversed ? child : after(child), reversed);
  }

  void place_triangles(std::size_t k) {
    const Part& part = parts_[k];
    const Triangulation& old = part.from.mesh;
    Triangulation& mesh = made_.part.mesh;
    IdVector<TriangleId, TriangleId> new_triangle(old.triangles.size(), kNone);
    for (const TriangleId t : ids_of(old.triangles)) {
      if (!old.triangles[t].alive()) continue;
      new_triangle[t] = made_.triangle.next_id();
      made_.triangle.push_back({index_of_part(k), t});
      if (labeled_) mesh.region.push_back(old.region.empty() ? std::uint16_t{0} : old.region[t]);
      Triangle triangle = old.triangles[t];
      for (VertexId& v : triangle.vertex) v = part.new_vertex[v];
      mesh.triangles.push_back(triangle);
    }
    for (const TriangleId t : ids_of(old.triangles)) {
      if (!old.triangles[t].alive()) continue;
      for (const int i : {0, 1, 2}) {
        const HalfEdge h = old.triangles[t].neighbor[i], edge = half_edge(new_triangle[t], i);
        if (!is_constrained(h))
          mesh.triangles[new_triangle[t]].neighbor[i] = half_edge(new_triangle[triangle_of(h)], index_of(h));
        else if (const SubsegmentId leaf = part.new_leaf[subsegment_of(h)]; leaf != kNone)
          mesh.link(edge, constrained(leaf));
        else
          sew(part, old.subsegments[subsegment_of(h)], edge);
      }
    }
  }

  /// Links the edges on both sides of a leaf that is gone.
  void sew(const Part& part, const Subsegment& leaf, HalfEdge edge) {
    const auto [other, is_first] = open_.try_emplace({part.from.roots[leaf.root], leaf.path}, edge);
    if (!is_first) made_.part.mesh.link(edge, other->second);
  }

  const JoinedSubdomains& joined_;
  const Decomposition& now_;
  bool labeled_ = false;
  std::vector<Part> parts_;
  std::map<OnRoot, VertexId> midpoints_;    // on roots as they were
  std::map<GlobalPointId, VertexId> gone_;  // points that are none any more
  std::map<OnRoot, VertexId> middles_;      // the intervals are those of roots that there are now
  std::map<OnRoot, HalfEdge> open_;         // on leaves of roots as they were
  GluedSubdomain made_;
};

}  // namespace

GluedSubdomain glue_subdomains(std::span<const SubdomainMesh* const> meshes, const JoinedSubdomains& joined,
                               SubdomainId s) {
  return Gluing(meshes, joined, s).glued();
}

SubdomainMesh renamed_subdomain(const SubdomainMesh& mesh, const JoinedSubdomains& joined) {
  SubdomainMesh renamed = mesh;
  for (GlobalRootId& r : renamed.roots) r = joined.roots[r].root;
  for (const VertexId v : ids_of(renamed.points)) {
    renamed.points[v] = joined.points[renamed.points[v]].point;
    renamed.mesh.origin[v] = origin_of(joined.decomposition, renamed.points[v]);
  }
  return renamed;
}

Renaming renaming_of(const SubdomainMesh& mesh, const JoinedSubdomains& joined) {
  const auto keeps = [&](const RootInterval& now) { return now.interval == dyadic::kWhole; };
  if (!std::ranges::all_of(mesh.roots, [&](GlobalRootId r) { return keeps(joined.roots[r]); })) return Renaming::kRoots;
  const bool same = std::ranges::all_of(mesh.roots, [&](GlobalRootId r) { return joined.roots[r].root == r; }) &&
                    std::ranges::all_of(mesh.points, [&](GlobalPointId v) { return joined.points[v].point == v; });
  return same ? Renaming::kNothing : Renaming::kNumbers;
}

}  // namespace driftmesh
