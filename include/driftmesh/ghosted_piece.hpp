#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// One rank's piece of a distributed mesh and a ring of ghosts around it: the triangles of other ranks that have a
/// point in common with a triangle of the piece, so that every triangle at a point of the piece is there.
///
/// \code
/// const auto piece = driftmesh::mesh_distributed(MPI_COMM_WORLD, driftmesh::generate("pipe"), {.max_area = 50});
/// const driftmesh::GhostedPiece ghosted = driftmesh::add_ghost_layer(MPI_COMM_WORLD, piece);
/// for (const driftmesh::GhostedPiece::Neighbor& n : ghosted.neighbors)
///   std::cout << n.sent.size() << " values to rank " << to_string(n.rank) << ", " << n.received.size() << " back\n";
/// \endcode
struct GhostedPiece {
  /// The triangles that this rank and one other have of each other, as indices into mesh.triangles: values on them are
  /// made current by sending those on `sent`, to be stored on `received` of the other side, in the same order.
  struct Neighbor {
    Rank rank{};
    std::vector<std::int32_t> sent;      ///< this rank's triangles that are ghosts there
    std::vector<std::int32_t> received;  ///< ghosts here
  };

  Rank rank{};
  std::int32_t ranks = 1;
  /// First what the piece has, in its order; then ghosts: triangles and points by number, subsegments that are sides of
  /// ghosts and that the piece has not. `numbers` and `subdomains` are those of the whole mesh, and `ranks` the owners
  /// of triangles.
  Mesh mesh;
  std::int32_t own_points = 0;
  std::int32_t own_triangles = 0;
  std::int32_t own_edges = 0;
  std::vector<Rank> owners;  ///< one for each point, ghost or not, the same on all ranks (see DistributedPiece)
  /// For each triangle in the whole mesh, from 0 to total_triangles - 1, whichever rank has it, its index in the one
  /// mesh into which all pieces are written (.vtu, .msh).
  std::vector<std::int64_t> triangle_numbers;
  std::vector<Neighbor> neighbors;  ///< sorted by rank; every rank with ghosts here, which has some of this one, too
};

}  // namespace driftmesh
