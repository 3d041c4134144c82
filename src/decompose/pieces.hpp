#pragma once

#include <cstdint>
#include <vector>

#include "decompose/planar_map.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh {

/// The index of a piece in the list of all pieces.
using PieceId = std::int32_t;

/// A piece of the domain, with one loop of the map as its border.
struct Piece {
  SideId side = kNone;     ///< one side of its loop
  std::int32_t parts = 0;  ///< number of subdomains to be made of it; 0: it will be merged with a neighbor
  double area = 0;
  double work = 0;
};

/// The pieces into which the walls divide the domain, one for each loop.
[[nodiscard]] std::vector<Piece> find_pieces(const PlanarMap& map, const QualityBounds& bounds);

/// Distributes `parts` among the pieces by their work, with at least one for each connected part of the domain. Throws
/// Error if `parts` is too small for that.
void allot_parts(const PlanarMap& map, std::vector<Piece>& pieces, std::int32_t parts);

/// For each side in the domain the index of the piece it belongs to, kNone for the others.
[[nodiscard]] IdVector<SideId, PieceId> label_sides(const PlanarMap& map, const std::vector<Piece>& pieces);

/// Groups adjacent pieces into `count` subdomains: by graph partitioning if there are many more pieces; then, while
/// there are too many groups, the lightest one is joined with its lightest neighbor. Returns the subdomain of each
/// piece, numbered in the order of their first pieces.
[[nodiscard]] std::vector<std::int32_t> group_pieces(const PlanarMap& map, const std::vector<Piece>& pieces,
                                                     std::int32_t count);

}  // namespace driftmesh
