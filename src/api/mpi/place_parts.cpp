#include "api/mpi/place_parts.hpp"

#include <map>
#include <memory>
#include <utility>

#include "adapt/few_moves.hpp"
#include "adapt/of_all_parts.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"

namespace driftmesh {
namespace {

std::shared_ptr<const balancer::Layout> layout_of(const Decomposition& decomposition,
                                                  const adapt::Generation& generation) {
  auto layout = std::make_shared<balancer::Layout>();
  layout->ranks = generation.piece.ranks;
  for (const SubdomainId s : ids_of(decomposition.subdomains)) {
    const Point& at = decomposition.subdomains[s].centroid;
    layout->subdomains.push_back({.x = at.x, .y = at.y, .owner = generation.holders[s], .neighbors = {}});
  }
  for (const Interface& i : interfaces(decomposition)) {
    layout->subdomains[i.first].neighbors.push_back({i.second, i.length});
    layout->subdomains[i.second].neighbors.push_back({i.first, i.length});
  }
  return layout;
}

/// The ranks of the parts of this one. Collective.
std::map<SubdomainId, Rank> place_by_zoltan(MPI_Comm communicator, const Decomposition& decomposition,
                                            const adapt::Loads& loads, const adapt::Generation& generation) {
  balancer::LoadSnapshot own;
  own.layout = layout_of(decomposition, generation);
  for (const double speed : loads.speeds) own.ranks.push_back({.speed = speed});
  for (const SubdomainId s : ids_of(loads.work)) own.ranks[generation.holders[s]].remaining += loads.work[s];
  for (const SubdomainId s : generation.here)
    own.subdomains.push_back({.id = s,
                              .owner = generation.holders[s],
                              .remaining = loads.work[s],
                              .bytes = static_cast<std::uint64_t>(loads.bytes[s]),
                              .cost = loads.bytes[s]});
  const std::vector<balancer::Part> parts = balancer::zoltan_partition(
      own,
      {{"LB_METHOD", "GRAPH"}, {"GRAPH_PACKAGE", "PHG"}, {"IMBALANCE_TOL", "1.03"}, {"PHG_EDGE_SIZE_THRESHOLD", "1.0"}},
      MPI_Comm_c2f(communicator));
  std::map<SubdomainId, Rank> ranks;
  for (std::size_t i = 0; i < parts.size(); ++i) ranks[generation.here[i]] = static_cast<Rank>(parts[i]);
  return ranks;
}

}  // namespace

std::vector<Rank> place_parts(MPI_Comm communicator, Ranks& ranks, const Decomposition& decomposition,
                              const adapt::Loads& loads, const adapt::Generation& generation) {
  constexpr double kEven = 1.05;
  if (adapt::imbalance(loads, generation.holders) <= kEven) return {};
  std::vector<std::pair<SubdomainId, SubdomainId>> neighbors;
  for (const Interface& i : interfaces(decomposition)) neighbors.emplace_back(i.first, i.second);
  IdVector<SubdomainId, Rank> holders = adapt::few_moves(loads, generation.holders, neighbors, kEven);
  if (adapt::imbalance(loads, holders) > kEven) {
    const std::map<SubdomainId, Rank> own = place_by_zoltan(communicator, decomposition, loads, generation);
    holders = adapt::of_all_parts(ranks, generation, [&](SubdomainId s) { return own.at(s); });
    holders = adapt::few_moves(loads, holders, neighbors, kEven);
  }
  std::vector<Rank> own;
  for (const SubdomainId s : generation.here) own.push_back(holders[s]);
  return own;
}

}  // namespace driftmesh
