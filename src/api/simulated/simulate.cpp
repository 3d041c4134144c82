#include <algorithm>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "api/simulated/cluster_request.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "cluster/cluster_spec.hpp"
#include "driftmesh/simulated.hpp"
#include "job/check.hpp"
#include "job/prepare.hpp"
#include "job/simulated/run_simulated.hpp"

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
  call.check(job::kSimulated, request);
  const CostModel costs;
  const IdVector<Rank, double> speeds = speeds_of(job::cluster_of(request), costs);
  job::Domain domain = call.read_domain();
  const job::Use use{.by = job::kLibrary, .in_subdomains = true, .sleeps = request.run.sleep};
  const job::Limits limits = job::find_limits(request.limits, domain.pslg, use, {});
  const auto ranks = static_cast<std::int32_t>(speeds.size());
  const job::Prepared prepared =
      job::prepare(request, domain, job::triangulate_domain(request, domain, ranks, job::Cut::kAlways, call.watch()),
                   call.given(), job::kSimulated, speeds, limits, call.watch());
  job::RunRecord record;
  return result_of(job::run_simulated(request, prepared, limits, costs, record, call.watch()), prepared.plan, speeds);
}

}  // namespace

SimulatedRun simulate(const Pslg& input, const MeshOptions& options, const SimulatedCluster& cluster) {
  return with_words_of_options([&] {
    Call call(input, options, balancer::make_policy);
    return run_on(call, cluster);
  });
}

}  // namespace driftmesh
