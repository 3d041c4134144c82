#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// A part of a graph that stays connected whichever point is removed, or a single edge; two parts share at most a point
/// (biconnected components).
enum class BlockId : std::int32_t {};

struct Blocks {
  IdVector<BlockId, std::vector<std::int32_t>>
      edges;  ///< for each block, ascending; blocks are in the order of their first
  std::vector<BlockId> of_edge;
};

/// The blocks of a graph with this number of points, whose edges are pairs of different points. Linear time (Hopcroft
/// and Tarjan, Algorithm 447, CACM 16(6), 1973).
[[nodiscard]] Blocks blocks_of(std::size_t points, const std::vector<std::array<std::int32_t, 2>>& edges);

}  // namespace driftmesh
