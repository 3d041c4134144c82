#pragma once

#include <cstdint>
#include <vector>

#include "decompose/planar_map.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/size_bound.hpp"

namespace driftmesh {

/// The index of a piece in the list of all pieces.
enum class PieceId : std::int32_t {};

/// A piece of the domain, with one loop of the map as its border.
struct Piece {
  SideId side = kNone;          ///< one side of its loop
  std::int32_t parts = 0;       ///< number of subdomains to be made of it; 0: it will be merged with a neighbor
  std::int32_t bundle = kNone;  ///< the pieces of a bundle become one subdomain, connected or not
  double area = 0;
  double work = 0;
};

/// The pieces into which the walls divide the domain, one for each loop.
[[nodiscard]] IdVector<PieceId, Piece> find_pieces(const PlanarMap& map, const SizeBounds& sizes);

/// If the domain has more connected parts than there are to be subdomains: bundles small parts that lie near each
/// other, so that each bundle has about the work of a subdomain. Returns the number of bundles.
[[nodiscard]] std::int32_t bundle_small_parts(const PlanarMap& map, IdVector<PieceId, Piece>& pieces,
                                              std::int32_t subdomains);

/// Distributes `parts` among the pieces outside bundles by their work, with at least one for each connected part of the
/// domain, for which `parts` must suffice.
void allot_parts(const PlanarMap& map, IdVector<PieceId, Piece>& pieces, std::int32_t parts);

/// For each side in the domain the index of the piece it belongs to, kNone for the others.
[[nodiscard]] IdVector<SideId, PieceId> label_sides(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces);

/// Groups pieces that are adjacent or of one bundle into `count` subdomains: by graph partitioning if there are many
/// more pieces; then, while there are too many groups, the lightest one is joined with its lightest neighbor. Returns
/// the subdomain of each piece, numbered in the order of their first pieces.
[[nodiscard]] IdVector<PieceId, SubdomainId> group_pieces(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces,
                                                          std::int32_t count);

}  // namespace driftmesh
