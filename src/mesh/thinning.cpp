#include "mesh/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/flips.hpp"

namespace driftmesh {
namespace {

bool precedes(const Point& a, const Point& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

class Thinning {
 public:
  Thinning(Triangulation& mesh, double min_angle, const AreaBounds& areas)
      : mesh_(mesh), areas_(areas), step_(*areas.sizes().step()) {
    const double sine = std::sin(min_angle * (std::numbers::pi / 180));
    sin_squared_ = sine * sine * (1 + 1e-9);
  }

  /// The worst first, and again those that are left as long as any vertex goes.
  std::int64_t run() {
    for (const TriangleId t : ids_of(mesh_.triangles))
      if (mesh_.triangles[t].alive()) note(t);
    for (std::int64_t before = -1; before != deleted_;) {
      before = deleted_;
      std::vector<Item> items = std::exchange(left_, {});
      std::ranges::sort(items, [](const Item& a, const Item& b) {
        return a.room != b.room ? a.room < b.room
                                : std::ranges::lexicographical_compare(a.corners, b.corners, precedes);
      });
      for (const Item& item : items)
        if (is_there(item) && !mend(item.triangle)) left_.push_back(item);
    }
    return deleted_;
  }

 private:
  struct Item {
    double room;
    CornerPoints corners;  // sorted
    TriangleId triangle;
  };

  [[nodiscard]] CornerPoints corners(TriangleId t) const {
    return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
  }
  [[nodiscard]] CornerPoints sorted_corners(TriangleId t) const {
    CornerPoints sorted = corners(t);
    std::ranges::sort(sorted, precedes);
    return sorted;
  }
  void note(TriangleId t) {
    const CornerPoints at = corners(t);
    if (!step_.allowed(at)) left_.push_back({step_.room(at), sorted_corners(t), t});
  }
  /// Whether the triangle has not changed.
  [[nodiscard]] bool is_there(const Item& item) const {
    return mesh_.triangles[item.triangle].alive() && sorted_corners(item.triangle) == item.corners;
  }

  /// What deleting a vertex would do.
  struct Outcome {
    std::int64_t bad;  // triangles that do not allow the step
    double worst;      // the least room of these
  };

  /// Deletes the corner of a triangle after which things are best, if any improves them.
  bool mend(TriangleId t) {
    std::optional<VertexId> best;
    Outcome least{};
    for (const int i : order_of_corners(t)) {
      const VertexId v = mesh_.triangles[t].vertex[i];
      if (mesh_.origin[v] != kFree) continue;
      const std::optional<Outcome> found = tried(half_edge(t, i));
      if (!found) continue;
      if (best && std::pair(found->bad, -found->worst) >= std::pair(least.bad, -least.worst)) continue;
      best = v;
      least = *found;
    }
    if (!best) return false;
    changed_.clear();
    remove_vertex(mesh_, first_spoke(spoke_at(t, *best)), changed_);
    ++deleted_;
    std::ranges::sort(changed_);
    const auto twice = std::unique(changed_.begin(), changed_.end());
    changed_.erase(twice, changed_.end());
    for (const TriangleId made : changed_)
      if (mesh_.triangles[made].alive()) note(made);
    return true;
  }

  /// By their places.
  [[nodiscard]] std::array<int, 3> order_of_corners(TriangleId t) const {
    std::array<int, 3> order{0, 1, 2};
    std::ranges::sort(order, [&](int a, int b) { return precedes(mesh_.corner(t, a), mesh_.corner(t, b)); });
    return order;
  }
  [[nodiscard]] HalfEdge spoke_at(TriangleId t, VertexId v) const {
    const auto& vertex = mesh_.triangles[t].vertex;
    return half_edge(t, static_cast<int>(std::ranges::find(vertex, v) - vertex.begin()));
  }
  /// The next edge of the star around the apex of an edge, counterclockwise.
  [[nodiscard]] HalfEdge next_spoke(HalfEdge spoke) const {
    const HalfEdge across = mesh_.twin(half_edge(triangle_of(spoke), next(index_of(spoke))));
    return half_edge(triangle_of(across), next(index_of(across)));
  }
  /// The one that starts at the least point, so that the new triangles depend on places alone.
  [[nodiscard]] HalfEdge first_spoke(HalfEdge spoke) const {
    HalfEdge first = spoke;
    for (HalfEdge s = next_spoke(spoke); s != spoke; s = next_spoke(s))
      if (precedes(mesh_.points[mesh_.edge_start(s)], mesh_.points[mesh_.edge_start(first)])) first = s;
    return first;
  }

  /// Deletes the apex and puts it back. Nothing if that must not be done, or is of no use.
  std::optional<Outcome> tried(HalfEdge apex) {
    const VertexId v = mesh_.apex(apex);
    std::int64_t bad_before = 0;
    star_.clear();
    const HalfEdge first = first_spoke(apex);
    HalfEdge spoke = first;
    do {
      const TriangleId t = triangle_of(spoke);
      star_.emplace_back(t, mesh_.triangles[t]);
      if (!step_.allowed(corners(t))) ++bad_before;
      spoke = next_spoke(spoke);
    } while (spoke != first);
    changed_.clear();
    if (!remove_vertex(mesh_, first, changed_)) return std::nullopt;
    const std::optional<Outcome> outcome = judged(bad_before);
    put_back(v);
    return outcome;
  }

  /// The star as it has become.
  [[nodiscard]] std::optional<Outcome> judged(std::int64_t bad_before) const {
    Outcome outcome{0, 1};
    for (const auto& [t, before] : star_) {
      if (!mesh_.triangles[t].alive()) continue;
      const CornerPoints at = corners(t);
      if (is_skinny(at) || is_large(t, at)) return std::nullopt;
      if (step_.allowed(at)) continue;
      if (++outcome.bad >= bad_before) return std::nullopt;
      outcome.worst = std::min(outcome.worst, step_.room(at));
    }
    return outcome;
  }

  void put_back(VertexId v) {
    for (const auto& [t, before] : star_) {
      mesh_.triangles[t] = before;
    }
    for (const auto& [t, before] : star_)
      for (const int i : {0, 1, 2}) mesh_.link(half_edge(t, i), before.neighbor[i]);
    mesh_.free_triangles.resize(mesh_.free_triangles.size() - 2);  // a star of n becomes n - 2 triangles
    mesh_.free_vertices.pop_back();
    mesh_.origin[v] = kFree;
  }

  [[nodiscard]] bool is_skinny(const CornerPoints& t) const {
    const double twice = 2 * signed_area(t[0], t[1], t[2]);
    const double ab = squared_distance(t[0], t[1]), bc = squared_distance(t[1], t[2]),
                 ca = squared_distance(t[2], t[0]);
    return twice * twice < sin_squared_ * std::max({ab * bc, bc * ca, ca * ab});
  }
  [[nodiscard]] bool is_large(TriangleId t, const CornerPoints& at) const {
    const double twice = 2 * signed_area(at[0], at[1], at[2]);
    if (areas_.sizes().spares_thinned(at, twice)) return false;
    if (twice > areas_.constant(t)) return true;
    const auto at_corners = [&] {
      double least = kNoBound;
      for (const Point& p : at) least = std::min(least, areas_.sizes().length_at(p));
      return least;
    };
    return areas_.by_place() && areas_.above_size(at, twice, at_corners, true);
  }

  Triangulation& mesh_;
  const AreaBounds& areas_;
  const TimeStep& step_;
  double sin_squared_;
  std::vector<Item> left_;
  std::vector<std::pair<TriangleId, Triangle>> star_;
  std::vector<TriangleId> changed_;
  std::int64_t deleted_ = 0;
};

}  // namespace

std::int64_t thin_for_step(Triangulation& mesh, double min_angle, const AreaBounds& areas) {
  return areas.sizes().step() == nullptr ? 0 : Thinning(mesh, min_angle, areas).run();
}

}  // namespace driftmesh
