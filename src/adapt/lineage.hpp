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
  /// Calls visit(point, source) for each point of the new piece, for several at once. That a border divides two
  /// subdomains does not matter: a point on it is one of the subdomain with the lowest number on this rank.
  void visit_points(const std::function<void(std::int32_t, const Source&)>& visit) const;
  /// Calls visit(triangle, old, turn) for each triangle that is one of the old mesh, for several at once: its corner i
  /// is corner i + turn (modulo 3) of the old one.
  void visit_same_triangles(const std::function<void(std::int32_t, std::int32_t, int)>& visit) const;

  /// The old and the new mesh of one subdomain.
  struct Change {
    bool is_the_same = false;
    const Triangulation& old_mesh;
    const Triangulation& new_mesh;
    const IdVector<TriangleId, TriangleId>& same;   ///< see Descent; empty if the meshes are the same
    IdVector<TriangleId, std::int32_t> old_number;  ///< the number of each triangle in the whole mesh
    IdVector<TriangleId, std::int32_t> new_number;
    const IdVector<VertexId, std::int32_t>& old_place;  ///< where each vertex is among all points
    const IdVector<VertexId, std::int32_t>& new_place;
  };
  /// The subdomain with the lowest number of all that have a point of the new piece, on whatever rank.
  [[nodiscard]] SubdomainId lowest_at(std::int32_t point) const { return lowest_[to_index(point)]; }
  /// Replaces what this rank has found at points that it shares by what the rank of lowest_at() has. Collective.
  void settle_shared(std::vector<double>& values, std::size_t components) const;
  /// Calls visit for each subdomain here, for several at once.
  void visit_parts(const std::function<void(SubdomainId, const Change&)>& visit) const;
  /// The old point at a vertex that stays.
  [[nodiscard]] std::int32_t old_point_of(SubdomainId s, VertexId v) const {
    return before_.places[s][is_the_same(s) ? v : descents_[s].sources[v].vertex[0]];
  }

  /// For each point, or triangle, of the new mesh its number in the old one; -1: it is not there.
  [[nodiscard]] std::vector<std::int32_t> stayed_points() const;
  [[nodiscard]] std::vector<std::int32_t> stayed_triangles() const;

 private:
  [[nodiscard]] bool is_the_same(SubdomainId s) const { return before_.parts[s].mesh == after_.parts[s].mesh; }
  void for_each_part(const std::function<void(SubdomainId)>& work) const;

  const Generation& before_;
  const Generation& after_;
  std::int32_t threads_;
  Ranks& ranks_;
  IdVector<SubdomainId, Descent> descents_;  // empty where the part is the same
  std::vector<SubdomainId> lowest_here_;     // at each new point, of the subdomains of this rank
  std::vector<SubdomainId> lowest_;
};

}  // namespace driftmesh::adapt
