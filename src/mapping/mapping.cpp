#include "mapping/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "decompose/graph_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// METIS's manual advises recursive bisection up to this many parts.
constexpr std::int32_t kMostForRecursive = 8;

std::vector<double> speeds_of(const MappingOptions& options) {
  if (options.ranks < 1) throw Error("a mapping needs at least one rank, not " + std::to_string(options.ranks));
  if (options.speeds.empty()) return std::vector<double>(at(options.ranks), 1.0);
  if (options.speeds.size() != at(options.ranks))
    throw Error(std::to_string(options.speeds.size()) + " speeds given for " + std::to_string(options.ranks) +
                " ranks; give one for each");
  for (const double s : options.speeds)
    if (!(s > 0 && std::isfinite(s))) throw Error("the speed of a rank must be above 0, not " + std::to_string(s));
  return options.speeds;
}

std::vector<double> weights_of(const Decomposition& d, MappingWeight weight) {
  std::vector<double> weights;
  for (const auto& s : d.subdomains) weights.push_back(weight == MappingWeight::kArea ? s.area : s.predicted);
  return weights;
}

WeightedGraph graph_of(const Decomposition& d, std::vector<double> weights) {
  const std::vector<Interface> all = interfaces(d);
  WeightedGraph graph;
  graph.begin.assign(d.size() + 1, 0);
  for (const Interface& i : all) {
    ++graph.begin[at(i.first) + 1];
    ++graph.begin[at(i.second) + 1];
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbor.resize(2 * all.size());
  graph.edge_weight.resize(2 * all.size());
  std::vector<std::int32_t> end(graph.begin.begin(), graph.begin.end() - 1);
  const auto add = [&](SubdomainId from, SubdomainId to, double length) {
    graph.neighbor[at(end[at(from)])] = to;
    graph.edge_weight[at(end[at(from)]++)] = length;
  };
  for (const Interface& i : all) {
    add(i.first, i.second, i.length);
    add(i.second, i.first, i.length);
  }
  graph.vertex_weight = std::move(weights);
  return graph;
}

/// Consecutive subdomains: each goes where its middle falls when all weights are laid out along the ranks.
Assignment map_blocks(const std::vector<double>& weights, const std::vector<double>& speeds) {
  const double per_speed =
      std::accumulate(weights.begin(), weights.end(), 0.0) / std::accumulate(speeds.begin(), speeds.end(), 0.0);
  Assignment assignment;
  std::size_t rank = 0;
  double done = 0, limit = speeds[0] * per_speed;
  for (const double weight : weights) {
    while (done + weight / 2 > limit && rank + 1 < speeds.size()) limit += speeds[++rank] * per_speed;
    assignment.push_back(static_cast<RankId>(rank));
    done += weight;
  }
  return assignment;
}

Assignment map_round_robin(const Decomposition& d, std::int32_t ranks) {
  Assignment assignment;
  for (std::size_t i = 0; i < d.size(); ++i) assignment.push_back(static_cast<RankId>(i % at(ranks)));
  return assignment;
}

}  // namespace

MappingMethod mapping_method(const std::string& name) {
  if (name == "graph") return MappingMethod::kGraph;
  if (name == "block") return MappingMethod::kBlock;
  if (name == "round-robin") return MappingMethod::kRoundRobin;
  throw Error("unknown mapping '" + name + "'; use graph, block or round-robin");
}

Assignment map_subdomains(const Decomposition& d, const MappingOptions& options) {
  const std::vector<double> speeds = speeds_of(options);
  switch (options.method) {
    case MappingMethod::kBlock:
      return map_blocks(weights_of(d, options.weight), speeds);
    case MappingMethod::kRoundRobin:
      return map_round_robin(d, options.ranks);
    case MappingMethod::kGraph:
      break;
  }
  if (d.size() <= at(options.ranks)) return map_round_robin(d, options.ranks);  // one each; METIS would leave gaps
  return partition_graph(graph_of(d, weights_of(d, options.weight)), speeds,
                         options.ranks <= kMostForRecursive ? PartitionMethod::kRecursive : PartitionMethod::kDirect);
}

MappingReport report_mapping(const Decomposition& d, const Assignment& assignment, const MappingOptions& options) {
  const std::vector<double> speeds = speeds_of(options);
  std::vector<double> work(speeds.size(), 0);
  for (std::size_t i = 0; i < d.size(); ++i) work[at(assignment[i])] += d.subdomains[i].predicted;
  const double mean =
      std::accumulate(work.begin(), work.end(), 0.0) / std::accumulate(speeds.begin(), speeds.end(), 0.0);
  MappingReport report;
  for (std::size_t r = 0; r < work.size(); ++r)
    report.largest_load = std::max(report.largest_load, work[r] / (speeds[r] * mean));
  double whole = 0;
  for (const Interface& i : interfaces(d)) {
    whole += i.length;
    if (assignment[at(i.first)] != assignment[at(i.second)]) report.interface_length += i.length;
  }
  report.share_between_ranks = whole > 0 ? report.interface_length / whole : 0;
  return report;
}

}  // namespace driftmesh
