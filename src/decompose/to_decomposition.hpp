#pragma once

#include <cstdint>

#include "decompose/decomposition.hpp"
#include "decompose/pieces.hpp"
#include "decompose/planar_map.hpp"

namespace driftmesh {

/// The finished decomposition: piece i becomes part of subdomain group_of[i]. Separators and bridges inside a subdomain
/// are dropped, along with the points that only they used. Subdomains are renumbered along a Hilbert curve of their
/// centroids.
[[nodiscard]] Decomposition to_decomposition(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces,
                                             IdVector<PieceId, SubdomainId> group_of, std::int32_t count);

}  // namespace driftmesh
