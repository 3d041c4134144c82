#pragma once

#include <cstdint>
#include <vector>

#include "decompose/planar_map.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh {

/// The index of a piece in a list of all.
using PieceId = std::int32_t;

/// A piece of the domain, with one loop of the map as its border.
struct Piece {
  SideId side = kNone;     ///< one side of its loop
  std::int32_t parts = 0;  ///< subdomains that it is to become; 0: it will be merged with a neighbor
  double area = 0;
  double work = 0;
};

/// The pieces that the walls make of the domain, one for each loop.
[[nodiscard]] std::vector<Piece> find_pieces(const PlanarMap& map, const QualityBounds& bounds);

/// Deals out `parts` among the pieces by their work: at least one to each connected part of the domain. Throws Error if
/// there are fewer.
void allot_parts(const PlanarMap& map, std::vector<Piece>& pieces, std::int32_t parts);

/// For each side in the domain the index of the piece it belongs to, kNone for the others.
[[nodiscard]] IdVector<SideId, PieceId> label_sides(const PlanarMap& map, const std::vector<Piece>& pieces);

/// Groups pieces that touch into `count` subdomains: by a graph partition where there are many more of them; then,
/// while there are more groups, the lightest is joined with the neighbor that is lightest itself. Returns the
/// subdomain of each piece, numbered in the order of their first pieces.
[[nodiscard]] std::vector<std::int32_t> group_pieces(const PlanarMap& map, const std::vector<Piece>& pieces,
                                                     std::int32_t count);

}  // namespace driftmesh
