#include "app/real_cluster.hpp"

#include <optional>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "job/rank_run.hpp"

namespace driftmesh::app {

RealCluster::RealCluster() : team_(protocol::MpiSession::world()) {}

RealCluster::~RealCluster() {
  if (leads()) static_cast<void>(job::share(team_, [] { return std::optional<job::Order>(); }));
}

ClusterRun RealCluster::run(job::Order&& order, job::RunRecord& record, job::Watch& watch) {
  std::optional<job::Order> shared = job::share(
      team_, [&] { return std::optional(std::move(order)); }, balancer::make_policy);
  return job::run_with_log(team_, std::move(*shared), record, watch);
}

void RealCluster::serve() {
  job::Watch watch;
  while (std::optional<job::Order> order = job::share(team_, {}, balancer::make_policy)) {
    job::RunRecord unused;
    job::cap_memory(order->limits);
    try {
      static_cast<void>(job::run_with_log(team_, std::move(*order), unused, watch));
    } catch (const std::exception&) {  // all ranks have it, and rank 0 decides what is next
    }
  }
}

}  // namespace driftmesh::app
