#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// An undirected graph with weights. Each edge is listed at both of its ends.
struct WeightedGraph {
  IdVector<std::int32_t, std::int32_t> begin{0};  ///< neighbors of vertex v: from begin[v] up to begin[v + 1]
  IdVector<std::int32_t, std::int32_t> neighbor;
  IdVector<std::int32_t, double> edge_weight;    ///< one for each entry of neighbor, > 0
  IdVector<std::int32_t, double> vertex_weight;  ///< >= 0
  [[nodiscard]] std::size_t size() const { return vertex_weight.size(); }
};

enum class PartitionMethod {
  kRecursive,  ///< recursive bisection: better for up to about 8 parts
  kDirect,     ///< k-way: better for more
};

/// Whether this build can, by METIS. Without, cuts join pieces one by one; mappings are in blocks.
[[nodiscard]] bool can_partition_graphs();

/// Partitions a graph into parts with the given shares of the weight (positive, on any scale, one for each part) and
/// little edge weight between them. A part may be empty or disconnected. Deterministic for a seed, whatever other
/// threads do; concurrent calls are serialized. Uses METIS (Karypis and Kumar 1998). Throws Error if METIS fails
/// or this build lacks it.
[[nodiscard]] IdVector<std::int32_t, std::int32_t> partition_graph(const WeightedGraph& graph,
                                                                   const std::vector<double>& shares,
                                                                   PartitionMethod method, std::int32_t seed = 1);

}  // namespace driftmesh
