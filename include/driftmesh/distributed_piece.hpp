#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// One rank's part of a distributed mesh, for a solver in the same job: the subdomains that the rank holds, joined into
/// one mesh, and the vertices that it shares with other ranks.
///
/// \code
/// const auto piece = driftmesh::mesh_distributed(MPI_COMM_WORLD, driftmesh::generate("pipe"), {.max_area = 50});
/// std::int64_t points = std::count(piece.owners.begin(), piece.owners.end(), piece.rank);
/// MPI_Allreduce(MPI_IN_PLACE, &points, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
/// assert(points == piece.total_points);  // each point has one owner
/// \endcode
struct DistributedPiece {
  /// The vertices that this rank shares with one other rank.
  struct Neighbor {
    Rank rank{};
    std::vector<std::int32_t> shared;  ///< indices into mesh.points, in the same order on both sides
  };

  Rank rank{};
  std::int32_t ranks = 1;
  /// Includes numbers, subdomains and ranks. Vertices are sorted by number. Numbers run from 0 to total_points - 1 over
  /// the whole mesh and depend only on the decomposition and the mesh, not on the distribution. Triangles are sorted by
  /// subdomain. A subsegment of the input between two ranks is in the pieces of both.
  Mesh mesh;
  std::vector<Rank> owners;         ///< for each vertex one of the ranks that have it, the same on all of them
  std::vector<Neighbor> neighbors;  ///< sorted by rank; every rank with a shared vertex
  bool has_regions = false;       ///< whether the whole mesh has regions; then mesh.regions has one entry per triangle
  std::int64_t total_points = 0;  ///< points in the whole mesh, each counted once
  std::int64_t total_triangles = 0;  ///< triangles in the whole mesh
};

}  // namespace driftmesh
