#include "api/mpi/place_parts.hpp"

#include <map>
#include <utility>

#include "adapt/few_moves.hpp"
#include "adapt/of_all_parts.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh {
namespace {

/// The ranks of the parts of this one. Collective.
std::map<SubdomainId, Rank> place_by_zoltan(MPI_Comm communicator, const Decomposition& decomposition,
                                            const adapt::Loads& loads, const adapt::Generation& generation) {
  balancer::LoadSnapshot own;
  own.layout = layout_of(decomposition, generation.holders, generation.piece.ranks);
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
  const IdVector<SubdomainId, Rank> holders = adapt::even_holders(loads, generation.holders, decomposition, [&] {
    const std::map<SubdomainId, Rank> chosen = place_by_zoltan(communicator, decomposition, loads, generation);
    return adapt::of_all_parts(ranks, generation, [&](SubdomainId s) { return chosen.at(s); });
  });
  if (holders == generation.holders) return {};
  std::vector<Rank> own;
  for (const SubdomainId s : generation.here) own.push_back(holders[s]);
  return own;
}

}  // namespace driftmesh
