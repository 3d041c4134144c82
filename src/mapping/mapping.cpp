#include "mapping/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/formatted.hpp"
#include "decompose/graph_partition.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// METIS's manual recommends recursive bisection up to this many parts.
constexpr std::int32_t kMostForRecursive = 8;

IdVector<Rank, double> speeds_of(const MappingOptions& options) {
  if (options.ranks < 1) throw Error("a mapping needs at least one rank, not " + std::to_string(options.ranks));
  if (options.speeds.empty()) return IdVector<Rank, double>(to_index(options.ranks), 1.0);
  if (options.speeds.size() != to_index(options.ranks))
    throw Error(std::to_string(options.speeds.size()) + " speeds given for " + std::to_string(options.ranks) +
                " ranks; give one for each");
  for (const double s : options.speeds)
    if (!(s > 0 && std::isfinite(s))) throw Error(formatted("the speed of a rank must be above 0, not {}", s));
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
    ++graph.begin[to_int(i.first) + 1];
    ++graph.begin[to_int(i.second) + 1];
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbor.resize(2 * all.size());
  graph.edge_weight.resize(2 * all.size());
  IdVector<SubdomainId, std::int32_t> end(graph.begin.begin(), graph.begin.end() - 1);
  const auto add = [&](SubdomainId from, SubdomainId to, double length) {
    graph.neighbor[end[from]] = to_int(to);
    graph.edge_weight[end[from]++] = length;
  };
  for (const Interface& i : all) {
    add(i.first, i.second, i.length);
    add(i.second, i.first, i.length);
  }
  graph.vertex_weight.assign(weights.begin(), weights.end());
  return graph;
}

/// Consecutive subdomains: each goes to the rank at its midpoint when all weights are laid out along the ranks.
Assignment map_blocks(const std::vector<double>& weights, const IdVector<Rank, double>& speeds) {
  const double per_speed =
      std::accumulate(weights.begin(), weights.end(), 0.0) / std::accumulate(speeds.begin(), speeds.end(), 0.0);
  Assignment assignment;
  Rank rank{0};
  double done = 0, limit = speeds.front() * per_speed;
  for (const double weight : weights) {
    for (Rank next = after(rank); done + weight / 2 > limit && speeds.has(next); rank = next, next = after(rank))
      limit += speeds[next] * per_speed;
    assignment.push_back(rank);
    done += weight;
  }
  return assignment;
}

Assignment map_round_robin(const Decomposition& d, std::int32_t ranks) {
  Assignment assignment;
  for (const SubdomainId i : ids_of(d.subdomains)) assignment.push_back(Rank{to_int(i) % ranks});
  return assignment;
}

Assignment map_to_all(const Decomposition& d, const MappingOptions& options) {
  const IdVector<Rank, double> speeds = speeds_of(options);
  switch (options.method) {
    case MappingMethod::kBlock:
      return map_blocks(weights_of(d, options.weight), speeds);
    case MappingMethod::kRoundRobin:
      return map_round_robin(d, options.ranks);
    case MappingMethod::kGraph:
      if (!can_partition_graphs()) return map_blocks(weights_of(d, options.weight), speeds);
      break;
  }
  if (d.size() <= to_index(options.ranks))
    return map_round_robin(d, options.ranks);  // one each; METIS would leave gaps
  Assignment assignment;
  for (const std::int32_t part :
       partition_graph(graph_of(d, weights_of(d, options.weight)), speeds,
                       options.ranks <= kMostForRecursive ? PartitionMethod::kRecursive : PartitionMethod::kDirect))
    assignment.push_back(Rank{part});
  return assignment;
}

bool is_absent(const MappingOptions& options, Rank r) {
  return options.absent.has(r) && options.absent[r];
}

}  // namespace

Assignment map_subdomains(const Decomposition& d, const MappingOptions& options) {
  const IdVector<Rank, double> speeds = speeds_of(options);
  std::vector<Rank> there;
  MappingOptions among_them = options;
  among_them.speeds.clear();
  for (const Rank r : ids_of(speeds)) {
    if (is_absent(options, r)) continue;
    there.push_back(r);
    among_them.speeds.push_back(speeds[r]);
  }
  if (there.empty()) throw Error("no rank is there to map work to");
  among_them.ranks = static_cast<std::int32_t>(there.size());
  Assignment assignment = map_to_all(d, among_them);
  for (Rank& rank : assignment) rank = there[to_index(rank)];
  return assignment;
}

MappingReport report_mapping(const Decomposition& d, const Assignment& assignment, const MappingOptions& options) {
  const IdVector<Rank, double> speeds = speeds_of(options);
  IdVector<Rank, double> work(speeds.size(), 0);
  for (const SubdomainId i : ids_of(d.subdomains)) work[assignment[i]] += d.subdomains[i].predicted;
  double speed = 0;
  for (const Rank r : ids_of(speeds)) speed += is_absent(options, r) ? 0 : speeds[r];
  const double mean = std::accumulate(work.begin(), work.end(), 0.0) / speed;
  MappingReport report;
  for (const Rank r : ids_of(work)) report.largest_load = std::max(report.largest_load, work[r] / (speeds[r] * mean));
  double whole = 0;
  for (const Interface& i : interfaces(d)) {
    whole += i.length;
    if (assignment[i.first] != assignment[i.second]) report.interface_length += i.length;
  }
  report.share_between_ranks = whole > 0 ? report.interface_length / whole : 0;
  return report;
}

}  // namespace driftmesh
