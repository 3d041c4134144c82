#include "adapt/mend.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "decompose/presplit.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/flips.hpp"
#include "mesh/renumber.hpp"

namespace driftmesh::adapt {
namespace {

class Mending {
 public:
  Mending(const SubdomainMesh& part, const Lengths& made_for, const Lengths& lengths, const QualityBounds& bounds,
          const PointsToKeep& keep)
      : part_(std::make_shared<SubdomainMesh>(part)),
        mesh_(part_->mesh),
        made_for_(made_for),
        lengths_(lengths),
        keep_(keep),
        areas_(mesh_, bounds),
        lens_(std::cos(std::min(120.0, 180 - 2 * bounds.min_angle) * (std::numbers::pi / 180))),
        triangle_at_(mesh_.points.size(), kNone),
        is_open_(mesh_.triangles.size(), false) {
    for (const TriangleId t : ids_of(mesh_.triangles))
      if (mesh_.triangles[t].alive()) note_corners(t);
  }

  Mended run() {
    delete_vertices();
    if (undo_midpoints()) {
      drop_unused_subsegments(mesh_);
      delete_vertices();  // those next to the border, which it protected
    }
    Mended mended{part_, {}};
    for (const TriangleId t : ids_of(mesh_.triangles))
      if (mesh_.triangles[t].alive() && (is_open_[t] || is_too_large(t))) mended.open.push_back(t);
    std::ranges::reverse(mended.open);  // the refiner takes the last one first
    return mended;
  }

 private:
  void note_corners(TriangleId t) {
    for (const VertexId v : mesh_.triangles[t].vertex) triangle_at_[v] = t;
  }
  void note_changes() {
    for (const TriangleId t : changed_) {
      is_open_[t] = true;
      if (mesh_.triangles[t].alive()) note_corners(t);
    }
    changed_.clear();
  }

  [[nodiscard]] double twice_area(TriangleId t) const {
    return 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }
  [[nodiscard]] bool is_too_large(TriangleId t) const {
    const auto& v = mesh_.triangles[t].vertex;
    const double least = std::min({lengths_[v[0]], lengths_[v[1]], lengths_[v[2]]});
    const double twice = twice_area(t);
    if (twice > std::min(areas_.constant(t), twice_area_of_edge(least))) return true;
    const auto at_corners = [&] { return least; };
    return areas_.by_place() &&
           areas_.above_size({mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)}, twice, at_corners, true);
  }

  /// Without the vertex, the largest triangle in its place has a third of the area or somewhat more; those that are too
  /// large are refined again. Asking for certainty here (a half) lets the mesh become 2 to 7 % denser over generations.
  [[nodiscard]] bool is_dispensable(VertexId v, HalfEdge h) const {
    constexpr double kLargest = 0.33;
    double star = 0, least = lengths_[v], constant = kNoBound;
    HalfEdge spoke = h;
    do {
      const TriangleId t = triangle_of(spoke);
      star += twice_area(t);
      least = std::min(least, lengths_[mesh_.edge_start(spoke)]);
      constant = std::min(constant, areas_.constant(t));
      const HalfEdge across = mesh_.twin(half_edge(t, next(index_of(spoke))));
      spoke = half_edge(triangle_of(across), next(index_of(across)));
    } while (spoke != h);
    return kLargest * star <= std::min(constant, twice_area_of_edge(least));
  }

  void delete_vertices() {
    for (const VertexId v : ids_of(mesh_.points)) {
      if (mesh_.origin[v] != kFree || !(lengths_[v] > kGrown * made_for_[v])) continue;
      const TriangleId t = triangle_at_[v];
      const HalfEdge h = half_edge(t, mesh_.corner_of(t, v));
      if (is_dispensable(v, h) && remove_vertex(mesh_, h, changed_)) note_changes();
    }
  }

  bool undo_midpoints() {
    bool any = false;
    for (const RootId r : ids_of(mesh_.roots)) {
      if (mesh_.roots[r].shell != kNone) continue;  // equal on all segments of the corner
      const auto kept = keep_.find(r);
      any = undo_below(mesh_.roots[r].tree, kept == keep_.end() ? nullptr : &kept->second) || any;
    }
    return any;
  }

  bool undo_below(SubsegmentId s, const std::vector<dyadic::Path>* keep) {
    const Subsegment node = mesh_.subsegments[s];
    if (node.is_leaf()) return false;
    const bool first = undo_below(node.child, keep), second = undo_below(node.second_child(), keep);
    const bool leaves = mesh_.subsegments[node.child].is_leaf() && mesh_.subsegments[node.second_child()].is_leaf();
    if (!leaves || !may_be_undone(node, keep) || !undo_midpoint(mesh_, s, changed_)) return first || second;
    note_changes();
    return true;
  }

  [[nodiscard]] bool may_be_undone(const Subsegment& node, const std::vector<dyadic::Path>* keep) const {
    const Subsegment &first = mesh_.subsegments[node.child], &second = mesh_.subsegments[node.second_child()];
    const Point &a = mesh_.points[node.vertex[0]], &b = mesh_.points[node.vertex[1]];
    if (keep != nullptr) {
      if (std::ranges::binary_search(*keep, node.path)) return false;
    } else {
      double most = kNoBound, least = lengths_[first.vertex[1]];
      if (!(least > kGrown * made_for_[first.vertex[1]])) return false;
      for (const VertexId v : node.vertex) least = std::min(least, lengths_[v]);
      for (const HalfEdge h : {first.half[0], first.half[1]})
        if (h != kNone) most = std::min(most, areas_.constant(triangle_of(h)));
      most = std::min(most, twice_area_of_edge(least)) / 2;
      if (squared_distance(a, b) > kPresplitSpacing * kPresplitSpacing * most) return false;
    }
    return is_lens_empty(second.half[0], a, b) && is_lens_empty(first.half[1], a, b);
  }

  /// On one side, from the half-edge that leaves the midpoint along the subsegment.
  [[nodiscard]] bool is_lens_empty(HalfEdge h, const Point& a, const Point& b) const {
    if (h == kNone) return true;
    for (;;) {
      const HalfEdge across = mesh_.twin(half_edge(triangle_of(h), previous(index_of(h))));
      if (is_constrained(across)) return true;
      if (in_diametral_lens(mesh_.points[mesh_.apex(h)], a, b, lens_)) return false;
      h = across;
    }
  }

  std::shared_ptr<SubdomainMesh> part_;
  Triangulation& mesh_;
  const Lengths& made_for_;
  const Lengths& lengths_;
  const PointsToKeep& keep_;
  AreaBounds areas_;
  double lens_;  // cosine of its angle
  IdVector<VertexId, TriangleId> triangle_at_;
  IdVector<TriangleId, bool> is_open_;
  std::vector<TriangleId> changed_;
};

}  // namespace

Mended mend(const SubdomainMesh& part, const Lengths& made_for, const Lengths& lengths, const QualityBounds& bounds,
            const PointsToKeep& keep) {
  return Mending(part, made_for, lengths, bounds, keep).run();
}

}  // namespace driftmesh::adapt
