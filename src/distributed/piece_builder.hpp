#pragma once

#include <optional>
#include <span>
#include <vector>

#include "distributed/census.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/numbering.hpp"
#include "distributed/piece_places.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// The entry of a root in a sorted list, or null.
[[nodiscard]] NumberedRoot* find_root(std::span<NumberedRoot> roots, GlobalRootId root);

/// Merges a rank's subdomains into one piece. Ranks have already agreed on all shared data.
class PieceBuilder {
 public:
  PieceBuilder(Rank rank, const Decomposition& decomposition, const SubdomainTable& subdomains,
               std::span<const NumberedRoot> roots, std::span<const SubdomainCensus> census);

  /// `places`: as in PieceAssembly::piece.
  [[nodiscard]] DistributedPiece build(const HeldSubdomains& held, const Pslg& pslg, PiecePlaces* places = nullptr);

 private:
  using Place = std::int32_t;  // index of a vertex in the piece

  [[nodiscard]] Rank holder(SubdomainId i) const { return subdomains_.rank[i]; }
  void place_decomposition_points();
  void place_added_points();
  void reserve_triangles();
  [[nodiscard]] IdVector<VertexId, Place> add_subdomain(SubdomainId i, const SubdomainMesh& part, const Pslg& pslg);
  [[nodiscard]] IdVector<VertexId, Place> place_vertices(SubdomainId i, const SubdomainMesh& part);
  void set_point(Place place, const Point& p, SubdomainId i);
  void add_triangles(SubdomainId i, const Triangulation& mesh, const IdVector<VertexId, Place>& place,
                     const Pslg& pslg);
  void add_edges(SubdomainId i, const SubdomainMesh& part, const IdVector<VertexId, Place>& place);
  void mark_points(const Pslg& pslg);
  void set_attributes(const Pslg& pslg);
  void find_sharers();

  Rank rank_;
  const Decomposition& decomposition_;
  const SubdomainTable& subdomains_;
  std::span<const NumberedRoot> roots_;
  std::span<const SubdomainCensus> census_;

  DistributedPiece piece_;
  IdVector<Place, GlobalPointId> corners_;          // points of the decomposition here: the first vertices
  IdVector<GlobalPointId, Place> place_of_corner_;  // kNone elsewhere
  IdVector<GlobalRootId, Place> place_of_root_;     // the first point on each root here
  std::vector<Place> place_of_free_;                // the first inner point of each subdomain in the census
  IdVector<Place, bool> is_placed_;                 // its coordinates are known
};

}  // namespace driftmesh
