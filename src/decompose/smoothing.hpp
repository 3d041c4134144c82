#pragma once

#include "decompose/pieces.hpp"
#include "decompose/planar_map.hpp"

namespace driftmesh {

/// Shortens the separators of a domain that has been cut, and merges their ends where that makes fewer interfaces:
/// moves the points where separators meet, and contracts short separators. Walls make at least `angle` (radians), where
/// they did. No load becomes larger than the largest was.
void smooth(PlanarMap& map, IdVector<PieceId, Piece>& pieces, const IdVector<PieceId, SubdomainId>& group_of,
            std::int32_t subdomains, double angle);

}  // namespace driftmesh
