#include <algorithm>
#include <memory>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "api/simulated/cluster_request.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "cluster/cluster_spec.hpp"
#include "driftmesh/simulated.hpp"
#include "job/check.hpp"
#include "job/make.hpp"
#include "job/simulated/simulated_ranks.hpp"

namespace driftmesh {
namespace {

job::Request with_cluster(job::Request request, const SimulatedCluster& cluster) {
  visit_cluster(cluster, request, [](const char*, const char*, const auto& value, auto& place) { place = value; });
  return request;
}

template <class T, class Id>
std::vector<T> plain(const IdVector<Id, T>& values) {
  return {values.begin(), values.end()};
}

SimulatedRun result_of(const ClusterRun& run, const RunPlan& plan, const IdVector<Rank, double>& speeds) {
  SimulatedRun result{.seconds = run.makespan,
                      .ideal_seconds = ideal_seconds(run, speeds),
                      .triangles = run.triangles(),
                      .messages = run.messages(),
                      .message_bytes = run.message_bytes(),
                      .moves = {},
                      .ranks = {},
                      .speeds = plain(speeds),
                      .owners_before = {plan.owners.begin(), plan.owners.end()},
                      .owners_after = plain(run.owners)};
  for (const MoveRecord& m : run.moves) result.moves.push_back({m.subdomain, m.from, m.to, m.left, m.arrived, m.bytes});
  for (const RankOutcome& rank : run.ranks) {
    const RankTimes& t = rank.times;
    result.ranks.push_back({t.computing, t.sending, t.polling, t.balancing, t.idle});
  }
  return result;
}

SimulatedRun run_on(Call& call, const SimulatedCluster& cluster) {
  const job::Request request = with_cluster(call.request(), cluster);
  job::SimulatedRanks ranks(job::cluster_of(request));
  job::RunRecord record;
  const std::unique_ptr<job::Refined> made =
      job::make(call.asked(job::kSimulated, request), ranks, record, call.watch());
  return result_of(made->history(), *made->plan(), ranks.speeds(request));
}

}  // namespace

SimulatedRun simulate(const Pslg& input, const MeshOptions& options, const SimulatedCluster& cluster) {
  return in_words_of_library([&] {
    Call call(input, options, balancer::make_policy);
    return run_on(call, cluster);
  });
}

}  // namespace driftmesh
