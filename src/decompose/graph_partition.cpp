#include "decompose/graph_partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <string>

#include "base/assert.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

static_assert(sizeof(idx_t) == sizeof(std::int32_t), "METIS must have 32-bit indices");

/// Integers in proportion to the weights. Their sums must fit METIS's 32-bit integers.
std::vector<idx_t> to_integers(const std::vector<double>& weights, double least) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double scale = sum > 0 ? 5e8 / sum : 0;
  std::vector<idx_t> integers;
  for (const double w : weights) integers.push_back(static_cast<idx_t>(std::max(least, std::round(w * scale))));
  return integers;
}

std::vector<real_t> normalized(const std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  std::vector<real_t> targets;
  for (const double s : shares) targets.push_back(static_cast<real_t>(s / sum));
  return targets;
}

/// METIS reseeds and uses the C library's global random sequence and sets signal handlers while it works, so two
/// concurrent calls would influence each other.
std::mutex one_at_a_time;

}  // namespace

bool can_partition_graphs() {
  return true;
}

IdVector<std::int32_t, std::int32_t> partition_graph(const WeightedGraph& graph, const std::vector<double>& shares,
                                                     PartitionMethod method, std::int32_t seed) {
  DM_ASSERT(!shares.empty() && graph.begin.size() == graph.size() + 1);
  IdVector<std::int32_t, idx_t> part(graph.size(), 0);
  if (shares.size() == 1 || graph.size() < 2) return part;
  idx_t vertices = narrow<idx_t>(graph.size(), "vertices of a graph"), constraints = 1, cut = 0;
  idx_t parts = narrow<idx_t>(shares.size(), "parts of a graph");
  std::vector<idx_t> begin(graph.begin), neighbor(graph.neighbor);
  std::vector<idx_t> vertex_weight = to_integers(graph.vertex_weight, 0);
  std::vector<idx_t> edge_weight = to_integers(graph.edge_weight, 1);
  std::vector<real_t> targets = normalized(shares);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = seed;
  options[METIS_OPTION_NUMBERING] = 0;
  const auto run = method == PartitionMethod::kRecursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const std::lock_guard lock(one_at_a_time);
  const int status = run(&vertices, &constraints, begin.data(), neighbor.data(), vertex_weight.data(), nullptr,
                         edge_weight.data(), &parts, targets.data(), nullptr, options, &cut, part.data());
  if (status != METIS_OK)
    throw Error("METIS could not partition a graph of " + std::to_string(graph.size()) + " vertices into " +
                std::to_string(shares.size()) + " parts (status " + std::to_string(status) + ")");
  return part;
}

}  // namespace driftmesh
