#include "app/real_cluster.hpp"

#include <optional>
#include <utility>

#include "job/rank_run.hpp"

namespace driftmesh::app {

RealCluster::RealCluster() : team_(protocol::MpiSession::world()) {}

RealCluster::~RealCluster() {
  if (leads()) static_cast<void>(job::share(team_, [] { return std::optional<job::Order>(); }));
}

ClusterRun RealCluster::run(job::Order&& order, job::RunRecord& record, job::Watch& watch) {
  std::optional<job::Order> shared = job::share(team_, [&] { return std::optional(std::move(order)); });
  return job::run_with_log(team_, std::move(*shared), record, watch);
}

void RealCluster::serve() {
  job::Watch watch;
  while (std::optional<job::Order> order = job::share(team_, {})) {
    job::RunRecord unused;
    static_cast<void>(job::run_with_log(team_, std::move(*order), unused, watch));
  }
}

}  // namespace driftmesh::app
