#pragma once

#include <cstdint>
#include <memory>

#include "adapt/linear_lengths.hpp"
#include "decompose/decomposition.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "distributed/piece_places.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh::adapt {

/// The mesh of a subdomain in one generation. It never changes: generations share those of subdomains that stay.
struct Part {
  std::shared_ptr<const SubdomainMesh> mesh;
  double asked = 0;    ///< triangles that lengths asked of it when it was made or mended (see Demand)
  double density = 0;  ///< triangles that it had for each asked one when it was last made from its outline; 0: unknown
  std::shared_ptr<const Lengths> made_for{};  ///< lengths by which its vertices were made; null: by none
};
using Parts = IdVector<SubdomainId, Part>;
using LengthsOfParts = IdVector<SubdomainId, Lengths>;

/// A mesh in parts, and as one whole.
struct Generation {
  Parts parts;
  DistributedPiece piece;
  IdVector<SubdomainId, IdVector<VertexId, std::int32_t>> places;  ///< see PiecePlaces
  IdVector<SubdomainId, std::int32_t> first_triangle;              ///< that each part has in the piece
};

/// `pslg`: see PieceAssembly::piece.
[[nodiscard]] Generation assemble(const Decomposition& decomposition, const Pslg& pslg, Parts parts);

}  // namespace driftmesh::adapt
