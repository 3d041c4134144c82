#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "adapt/descent.hpp"
#include "adapt/generation.hpp"
#include "distributed/ranks.hpp"

namespace driftmesh::adapt {

/// What one generation has from the one before, on this rank, which holds the same subdomains in both. All arguments
/// outlive the object. Collective.
class Lineage {
 public:
  Lineage(const Generation& before, const Generation& after, std::int32_t threads, Ranks& ranks);

  [[nodiscard]] const Generation& after() const { return after_; }
  [[nodiscard]] Ranks& ranks() const { return ranks_; }
  [[nodiscard]] std::size_t new_points() const { return after_.piece.mesh.points.size(); }
  [[nodiscard]] std::size_t new_triangles() const { return after_.piece.mesh.triangles.size(); }

  /// A point of the new mesh as a convex combination of points of the old one.
  struct Source {
    std::array<std::int32_t, 3> point{};
    std::array<double, 3> weight{};
    bool stays = false;  ///< it is the first of them
  };
  /// The old and the new mesh of one subdomain.
  struct Change {
    SubdomainId subdomain{};
    bool is_the_same = false;
    const Triangulation& old_mesh;
    const Triangulation& new_mesh;
    const Descent& descent;                         ///< empty if the meshes are the same
    IdVector<TriangleId, std::int32_t> old_number;  ///< the number of each triangle in the whole mesh
    IdVector<TriangleId, std::int32_t> new_number;
    const IdVector<VertexId, std::int32_t>& old_place;  ///< where each vertex is among all points
    const IdVector<VertexId, std::int32_t>& new_place;

    [[nodiscard]] bool stays(TriangleId t) const { return is_the_same || descent.same[t] != kNone; }
    /// The old point at a vertex that stays.
    [[nodiscard]] std::int32_t old_point_of(VertexId v) const {
      return old_place[is_the_same ? v : descent.sources[v].vertex[0]];
    }
  };
  /// Calls visit(change) for each subdomain here, for several at once. Where its new mesh comes from is found for the
  /// call, and forgotten after it.
  void visit_parts(const std::function<void(const Change&)>& visit) const;
  /// Calls visit(point, source) for the points of the subdomain that are not those of another one here with a lower
  /// number: for each point of the new piece once.
  void visit_points(const Change& change, const std::function<void(std::int32_t, const Source&)>& visit) const;

  /// The subdomain with the lowest number of all that have a point of the new piece, on whatever rank.
  [[nodiscard]] SubdomainId lowest_at(std::int32_t point) const { return lowest_[to_index(point)]; }
  /// Replaces what this rank has found at points that it shares by what the rank of lowest_at() has. Collective.
  void settle_shared(std::vector<double>& values, std::size_t components) const;

 private:
  const Generation& before_;
  const Generation& after_;
  std::int32_t threads_;
  Ranks& ranks_;
  std::vector<SubdomainId> lowest_here_;  // at each new point, of the subdomains of this rank
  std::vector<SubdomainId> lowest_;
};

/// Calls visit(triangle, old, turn) for each triangle of the subdomain that is one of the old mesh: its corner i is
/// corner i + turn (modulo 3) of the old one.
void visit_same_triangles(const Lineage::Change& change,
                          const std::function<void(std::int32_t, std::int32_t, int)>& visit);

}  // namespace driftmesh::adapt
