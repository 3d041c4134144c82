#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// One rank's part of a distributed mesh, as a solver in the same job uses it: the subdomains that the rank holds,
/// joined to one mesh, and which of its vertices other ranks have too.
struct DistributedPiece {
  /// The vertices that this rank shares with another one.
  struct Neighbor {
    Rank rank{};
    std::vector<std::int32_t> shared;  ///< indices into mesh.points, in the same order on both sides
  };

  Rank rank{};
  std::int32_t ranks = 1;
  /// With numbers, subdomains and ranks. Vertices ascend by their numbers. Numbers run from 0 to total_points - 1 over
  /// the whole mesh and depend on the decomposition and the mesh alone, not on who holds what. Triangles are sorted by
  /// subdomain. A subsegment of the input between two ranks is in the pieces of both.
  Mesh mesh;
  std::vector<Rank> owners;          ///< of each vertex: one of the ranks that have it, the same for all of them
  std::vector<Neighbor> neighbors;   ///< ascending by rank; every rank with a common vertex
  bool has_regions = false;          ///< the whole mesh has them, so mesh.regions has an entry for each triangle
  std::int64_t total_points = 0;     ///< of the whole mesh, each point counted once
  std::int64_t total_triangles = 0;  ///< of the whole mesh
};

}  // namespace driftmesh
