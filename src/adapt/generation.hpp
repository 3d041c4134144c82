#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "adapt/linear_lengths.hpp"
#include "decompose/decomposition.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "distributed/piece_places.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {

/// The mesh of a subdomain in one generation. It never changes: generations share those of subdomains that stay.
struct Part {
  std::shared_ptr<const SubdomainMesh> mesh;  ///< null: it is on another rank, and nothing else is known here, either
  double asked = 0;    ///< triangles that lengths asked of it when it was made or mended (see Demand)
  double density = 0;  ///< triangles that it had for each asked one when it was last made from its outline; 0: unknown
  std::shared_ptr<const Lengths> made_for{};  ///< lengths by which its vertices were made; null: by none
};
using Parts = IdVector<SubdomainId, Part>;
using LengthsOfParts = IdVector<SubdomainId, Lengths>;

/// A mesh in parts, each on one rank, and as one piece on each rank.
struct Generation {
  Parts parts;
  DistributedPiece piece;         ///< two fifths of the memory; what another generation is made from is in the rest
  std::vector<SubdomainId> here;  ///< those on this rank, ascending
  IdVector<SubdomainId, Rank> holders;  ///< the rank of each
  // Of parts that are here:
  IdVector<SubdomainId, IdVector<VertexId, std::int32_t>> places;  ///< see PiecePlaces
  IdVector<SubdomainId, std::int32_t> first_triangle;              ///< that each part has in the piece

  [[nodiscard]] bool is_here(SubdomainId s) const { return parts[s].mesh != nullptr; }
};

/// The number of each triangle of a part that is here in the piece; kNone for free slots.
[[nodiscard]] IdVector<TriangleId, std::int32_t> numbers_of_triangles(const Generation& generation, SubdomainId s);

/// The part that a session begins with. `made_for`: lengths by which it was made, at its vertices; empty: by none.
[[nodiscard]] Part first_part(SubdomainMesh mesh, const QualityBounds& bounds, Lengths made_for);

/// `pslg`: see PieceAssembly::piece. Collective.
[[nodiscard]] Generation assemble(const Decomposition& decomposition, const Pslg& pslg, Parts parts, Ranks& ranks);

}  // namespace driftmesh::adapt
