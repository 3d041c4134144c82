#include "cluster/cluster_run.hpp"

#include <numeric>

namespace driftmesh {
namespace {

template <class Value>
Value sum_of(const std::vector<RankOutcome>& ranks, Value RankOutcome::*member) {
  return std::accumulate(ranks.begin(), ranks.end(), Value{},
                         [=](Value sum, const RankOutcome& rank) { return sum + rank.*member; });
}

}  // namespace

std::int64_t ClusterRun::triangles() const {
  return sum_of(ranks, &RankOutcome::triangles);
}

std::uint64_t ClusterRun::messages() const {
  return sum_of(ranks, &RankOutcome::messages);
}

std::uint64_t ClusterRun::message_bytes() const {
  return sum_of(ranks, &RankOutcome::message_bytes);
}

double ideal_seconds(const ClusterRun& run, const IdVector<Rank, double>& speeds) {
  double work = 0;
  for (const Rank r : ids_of(run.ranks)) work += run.ranks[r].times.computing * speeds[r];
  return work / std::accumulate(speeds.begin(), speeds.end(), 0.0);
}

}  // namespace driftmesh
