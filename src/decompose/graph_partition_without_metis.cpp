#include "decompose/graph_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

bool can_partition_graphs() {
  return false;
}

IdVector<std::int32_t, std::int32_t> partition_graph(const WeightedGraph& /*graph*/,
                                                     const std::vector<double>& /*shares*/, PartitionMethod /*method*/,
                                                     std::int32_t /*seed*/) {
  throw Error(
      "partitioning a graph takes METIS, which this driftmesh was built without; build it with -DDRIFTMESH_METIS=ON");
}

}  // namespace driftmesh
