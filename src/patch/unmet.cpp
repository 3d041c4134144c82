#include "patch/unmet.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "adapt/length_growth.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/bounds.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh::patch {
namespace {

/// The lengths that are wanted at points, and what of them counts for triangles that are too dense: the same, but with
/// no wish where only the longest lengths are limited.
struct Wishes {
  adapt::Lengths most;
  std::vector<double> least;
};

Wishes wishes_of(const Triangulation& mesh, std::span<const double> lengths, const AdaptiveOptions& options) {
  Wishes wishes;
  for (const VertexId v : ids_of(mesh.points)) {
    const double asked = lengths.empty() ? options.longest : lengths[to_index(v)];
    wishes.most.push_back(std::clamp(asked, options.shortest, options.longest));
  }
  if (lengths.empty()) {
    wishes.least.assign(mesh.points.size(), options.shortest);
    return wishes;
  }
  if (options.gradation > 0) static_cast<void>(adapt::limit_growth(mesh, options.gradation, wishes.most));
  for (const VertexId v : ids_of(mesh.points)) wishes.least.push_back(wishes.most[v]);
  return wishes;
}

class Finding {
 public:
  Finding(const Mesh& mesh, const Triangulation& linked) : mesh_(mesh), linked_(linked) {
    unmet_.triangles.assign(mesh.triangles.size(), false);
  }

  Unmet run(const Wishes& wishes, double min_angle, double threshold) {
    for (const TriangleId t : ids_of(linked_.triangles)) {
      double least = std::numeric_limits<double>::infinity();
      for (const VertexId v : linked_.triangles[t].vertex) least = std::min(least, wishes.most[v]);
      if (twice_area(t) > twice_area_of_edge(least)) note(t, unmet_.too_large);
    }
    note_dense(wishes.least, threshold);
    for (const Exceptions::Item& item : find_exceptions(linked_, {.min_angle = min_angle}).skinny)
      if (item.cause != ExceptionCause::kInputAngle) note(item.triangle, unmet_.skinny);
    note_illegal();
    return std::move(unmet_);
  }

 private:
  [[nodiscard]] double twice_area(TriangleId t) const {
    return 2 * signed_area(linked_.corner(t, 0), linked_.corner(t, 1), linked_.corner(t, 2));
  }
  void note(TriangleId t, std::int64_t& reason) {
    if (unmet_.triangles[to_index(t)]) return;
    unmet_.triangles[to_index(t)] = true;
    ++reason;
  }

  /// Areas relative to those of the lengths that are wanted, 1 where they are met, in the mean of some rings of
  /// neighbors: single triangles vary much.
  void note_dense(const std::vector<double>& wanted, double threshold) {
    constexpr int kRings = 4;
    std::vector<double> at_triangle(mesh_.triangles.size()), at_point(mesh_.points.size());
    std::vector<std::int32_t> count(mesh_.points.size(), 0);
    for (const TriangleId t : ids_of(linked_.triangles)) {
      double least = std::numeric_limits<double>::infinity();
      for (const VertexId v : linked_.triangles[t].vertex) least = std::min(least, wanted[to_index(v)]);
      at_triangle[to_index(t)] = least > 0 ? kTrianglesPerBound * twice_area(t) / twice_area_of_edge(least)
                                           : std::numeric_limits<double>::max();
      at_triangle[to_index(t)] = std::min(at_triangle[to_index(t)], kMany);
      for (const VertexId v : linked_.triangles[t].vertex) ++count[to_index(v)];
    }
    for (int ring = 0; ring < kRings; ++ring) {
      std::ranges::fill(at_point, 0);
      for (const TriangleId t : ids_of(linked_.triangles))
        for (const VertexId v : linked_.triangles[t].vertex)
          at_point[to_index(v)] += at_triangle[to_index(t)] / count[to_index(v)];
      for (const TriangleId t : ids_of(linked_.triangles)) {
        double sum = 0;
        for (const VertexId v : linked_.triangles[t].vertex) sum += at_point[to_index(v)];
        at_triangle[to_index(t)] = sum / 3;
      }
    }
    for (const TriangleId t : ids_of(linked_.triangles))
      if (at_triangle[to_index(t)] * threshold * threshold < 1) note(t, unmet_.too_dense);
  }

  /// By edges that are not listed, within subdomains.
  void note_illegal() {
    const ConstrainedEdgeIndex index(mesh_);
    for (const TriangleId t : ids_of(linked_.triangles))
      for (int i = 0; i < 3; ++i) {
        const HalfEdge beyond = linked_.across(half_edge(t, i));
        if (beyond == kNone || triangle_of(beyond) < t) continue;
        const VertexId a = linked_.triangles[t].vertex[next(i)], b = linked_.triangles[t].vertex[previous(i)];
        const auto same = [&](const auto& labels) {
          return labels.empty() || labels[to_index(t)] == labels[to_index(triangle_of(beyond))];
        };
        if (!same(mesh_.subdomains) || !same(mesh_.regions) || index.find(to_int(a), to_int(b)) >= 0) continue;
        const Point& apex = linked_.points[linked_.apex(beyond)];
        if (!(incircle(linked_.corner(t, 0), linked_.corner(t, 1), linked_.corner(t, 2), apex) > 0)) continue;
        note(t, unmet_.not_delaunay);
        note(triangle_of(beyond), unmet_.not_delaunay);
      }
  }

  static constexpr double kMany = 4;  // nothing is so sparse that it makes up for many that are too dense

  const Mesh& mesh_;
  const Triangulation& linked_;
  Unmet unmet_;
};

}  // namespace

Unmet find_unmet(const Mesh& mesh, const Triangulation& linked, std::span<const double> lengths,
                 const AdaptiveOptions& options, double min_angle, double threshold) {
  return Finding(mesh, linked).run(wishes_of(linked, lengths, options), min_angle, threshold);
}

}  // namespace driftmesh::patch
