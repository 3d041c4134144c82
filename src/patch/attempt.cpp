#include "patch/attempt.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "geometry/predicates.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/fixed_corners.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"
#include "mesh/to_piece.hpp"
#include "patch/in_subdomains.hpp"

namespace driftmesh::patch {
namespace {

IdVector<RootId, bool> fixed_roots(const Triangulation& mesh, const Domain& domain) {
  if (mesh.roots.size() != domain.fixed.size())
    throw Error("the triangles to be made anew do not fit together, or lines of the new outline cross those that stay");
  IdVector<RootId, bool> fixed(mesh.roots.size(), false);
  for (const RootId r : ids_of(mesh.roots)) fixed[r] = domain.fixed[to_index(r)];
  return fixed;
}

/// A forecast that is so much above a limit is no mistake.
constexpr double kSurely = 4;

/// Whether nothing stays beside it, so that refinement may split and delete as it wants to.
bool is_whole(const Domain& domain) {
  return std::ranges::find(domain.fixed, true) == domain.fixed.end() &&
         std::ranges::find(domain.free, true) == domain.free.end();
}

class Judge {
 public:
  Judge(const Triangulation& mesh, const Part& part, const Extent& extent, const OldPlaces& old)
      : mesh_(mesh), part_(part), extent_(extent), old_(old), on_fixed_(mesh.points.size(), false) {}

  /// Points at which the mesh misses bounds, or is not Delaunay together with what stays.
  std::vector<std::int32_t> tight(const QualityBounds& bounds, const Domain& domain) {
    std::vector<SubsegmentId> fixed;
    for (std::size_t i = 0; i < domain.fixed.size(); ++i) {
      if (!domain.fixed[i]) continue;
      fixed.push_back(mesh_.roots[static_cast<RootId>(i)].tree);
      for (const VertexId v : mesh_.subsegments[fixed.back()].vertex) on_fixed_[v] = true;
    }
    if (fixed.empty()) return {};
    const Exceptions exceptions = find_exceptions(mesh_, bounds);
    for (const Exceptions::Item& item : exceptions.skinny)
      if (item.cause == ExceptionCause::kUnexplained || touches_fixed(item.triangle)) add_if_new(item.triangle);
    for (const TriangleId t : exceptions.large) add_if_new(t);
    for (std::size_t t = 0; t < part_.mesh.triangles.size(); ++t)
      if (!extent_.taken[t])
        for (std::size_t i = 0; i < 3; ++i) note_beyond(t, i);
    for (const SubsegmentId s : fixed) judge_edge(s);
    std::ranges::sort(tight_);
    tight_.erase(std::unique(tight_.begin(), tight_.end()), tight_.end());
    return std::move(tight_);
  }

 private:
  [[nodiscard]] bool touches_fixed(TriangleId t) const {
    return std::ranges::any_of(mesh_.triangles[t].vertex, [&](VertexId v) { return on_fixed_[v]; });
  }
  [[nodiscard]] bool is_new(TriangleId t) const {
    std::array<std::int32_t, 3> points{};
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = old_.point_at(mesh_.corner(t, static_cast<int>(i)));
      if (points[i] < 0) return true;
    }
    return old_.triangle_of(points) < 0;
  }
  /// The nearest points of the old mesh that a walk from the triangle finds.
  void add_if_new(TriangleId t) {
    if (!is_new(t)) return;
    std::vector<TriangleId> open{t};
    std::vector<TriangleId> seen{t};
    for (std::size_t i = 0; i < open.size() && i < kFar; ++i) {
      bool any = false;
      for (const VertexId v : mesh_.triangles[open[i]].vertex)
        if (const std::int32_t point = old_.point_at(mesh_.points[v]); point >= 0) {
          tight_.push_back(point);
          any = true;
        }
      if (any) return;
      for (int k = 0; k < 3; ++k) {
        const HalfEdge beyond = mesh_.across(half_edge(open[i], k));
        if (beyond == kNone || std::ranges::find(seen, triangle_of(beyond)) != seen.end()) continue;
        seen.push_back(triangle_of(beyond));
        open.push_back(triangle_of(beyond));
      }
    }
  }

  /// Triangle t stays. What is beyond its edge may not.
  void note_beyond(std::size_t t, std::size_t i) {
    const std::int32_t other = part_.beyond[t][i];
    if (other < 0 || !extent_.taken[to_index(other)]) return;
    const auto& corners = part_.mesh.triangles[t];
    const std::int32_t a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
    stays_.push_back({{std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(t)});
  }

  void judge_edge(SubsegmentId s) {
    if (!is_sorted_) std::ranges::sort(stays_);
    is_sorted_ = true;
    const Subsegment& segment = mesh_.subsegments[s];
    const std::int32_t a = old_.point_at(mesh_.points[segment.vertex[0]]);
    const std::int32_t b = old_.point_at(mesh_.points[segment.vertex[1]]);
    const std::pair ends(std::min(a, b), std::max(a, b));
    const auto found = std::ranges::lower_bound(stays_, ends, {}, &Stays::first);
    if (found == stays_.end() || found->first != ends || mesh_.roots[segment.root].marker != 0) return;
    const HalfEdge h = segment.half[0] != kNone ? segment.half[0] : segment.half[1];
    if (!is_new(triangle_of(h))) return;
    const auto& corners = part_.mesh.triangles[to_index(found->second)];
    const auto at = [&](std::size_t i) { return part_.mesh.points[to_index(corners[i])]; };
    if (incircle(at(0), at(1), at(2), mesh_.points[mesh_.apex(h)]) > 0) {
      tight_.push_back(a);
      tight_.push_back(b);
    }
  }

  static constexpr std::size_t kFar = 200;                                       // triangles
  using Stays = std::pair<std::pair<std::int32_t, std::int32_t>, std::int32_t>;  // ends of an edge, triangle

  const Triangulation& mesh_;
  const Part& part_;
  const Extent& extent_;
  const OldPlaces& old_;
  IdVector<VertexId, bool> on_fixed_;
  std::vector<Stays> stays_;
  bool is_sorted_ = false;
  std::vector<std::int32_t> tight_;
};

}  // namespace

Attempt attempt(const Domain& domain, const Part& part, const Extent& extent, const OldPlaces& old,
                QualityBounds bounds, const Making& making) {
  bounds.size = making.sizes.front();
  Triangulation mesh = triangulate(domain.pslg, domain.sides);
  const IdVector<RootId, bool> fixed = fixed_roots(mesh, domain);
  const double forecast = forecast_triangles(mesh, bounds);
  if (!(forecast <= kSurely * static_cast<double>(making.most_triangles))) refuse_many(making.most_triangles);
  if (is_whole(domain) && is_worth_cutting(mesh, forecast, making.cut_from)) {
    static_cast<void>(prepare_corners(mesh));
    return {refine_in_subdomains(mesh, domain.pslg, bounds, making.sizes, forecast, making.most_triangles), {}};
  }
  for (VertexOrigin& origin : mesh.origin)
    if (is_input(origin) && domain.free[to_index(origin)]) origin = kFree;
  static_cast<void>(prepare_corners(mesh, {bounds.min_angle, false, bounds.rules}, fixed));
  RefinerState state = RefinerState::at_start(mesh, bounds);
  for (const RootId r : ids_of(fixed))
    if (fixed[r]) state.unsplittable.insert(mesh.roots[r].tree);
  Refiner refiner(mesh, bounds, std::move(state));
  refiner.limit_triangles(making.most_triangles);
  if (refiner.refine() != Refiner::Status::kDone) refuse_many(making.most_triangles);
  Attempt made;
  made.tight = Judge(mesh, part, extent, old).tight(bounds, domain);
  made.mesh = to_piece(mesh, domain.pslg);
  return made;
}

}  // namespace driftmesh::patch
