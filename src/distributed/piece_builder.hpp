#pragma once

#include <optional>
#include <span>
#include <vector>

#include "distributed/census.hpp"
#include "distributed/distributed_piece.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/numbering.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The entry of a root in a list that ascends, or null.
[[nodiscard]] NumberedRoot* find_root(std::span<NumberedRoot> roots, RootId root);

/// Joins a rank's subdomains to one piece. Everything that ranks must agree on has been agreed on before.
class PieceBuilder {
 public:
  PieceBuilder(protocol::Rank rank, const Decomposition& decomposition, const SubdomainTable& subdomains,
               std::span<const NumberedRoot> roots, std::span<const SubdomainCensus> census);

  [[nodiscard]] DistributedPiece build(const HeldSubdomains& held, const Pslg& pslg);

 private:
  [[nodiscard]] protocol::Rank holder(SubdomainId i) const { return subdomains_.rank[static_cast<std::size_t>(i)]; }
  void place_decomposition_points();
  void place_added_points();
  void reserve_triangles();
  void add_subdomain(SubdomainId i, const SubdomainMesh& part, const Pslg& pslg);
  [[nodiscard]] std::vector<std::int32_t> place_vertices(SubdomainId i, const SubdomainMesh& part);
  void set_point(std::int32_t place, const Point& p, SubdomainId i);
  void add_triangles(SubdomainId i, const Triangulation& mesh, const std::vector<std::int32_t>& place,
                     const Pslg& pslg);
  void add_edges(SubdomainId i, const SubdomainMesh& part, const std::vector<std::int32_t>& place);
  void mark_points(const Pslg& pslg);
  void set_attributes(const Pslg& pslg);
  void find_sharers();

  protocol::Rank rank_;
  const Decomposition& decomposition_;
  const SubdomainTable& subdomains_;
  std::span<const NumberedRoot> roots_;
  std::span<const SubdomainCensus> census_;

  DistributedPiece piece_;
  std::vector<GlobalPointId> corners_;         // points of the decomposition in this piece: its first vertices
  std::vector<std::int32_t> place_of_corner_;  // of each point of the decomposition; kNone elsewhere
  std::vector<std::int32_t> place_of_root_;    // of each root of the decomposition: of the first point on it
  std::vector<std::int32_t> place_of_free_;    // of the first inner point of each subdomain in the census
  std::vector<bool> is_placed_;                // vertices whose coordinates are known
};

}  // namespace driftmesh
